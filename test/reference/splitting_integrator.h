#pragma once

#include <memory>

#include "stepping/plain_integrator.h"
#include "stepping/splitting.h"

namespace spherical_springs::core::testing {

/// Steps one spring at a time by the springs' own formulas: the reference for BlockedSplitting.
class SplittingIntegrator : public PlainIntegrator {
 public:
  SplittingIntegrator(std::shared_ptr<const System> system, const SplittingScheme& scheme,
                      double time_step);

 private:
  void stepOnce(State& state) override;
  const SplittingScheme& schemeFor(const State& state);
  void drift(double duration, State& state) const;
  void kick(double duration, State& state);

  std::shared_ptr<const System> system_;
  const SplittingScheme& scheme_;
  double time_step_;
  System::Workspace workspace_;
};

}  // namespace spherical_springs::core::testing
