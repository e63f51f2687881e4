#pragma once

#include <memory>
#include <vector>

#include "stepping/plain_integrator.h"

namespace spherical_springs::core {

/// A step as a composition of exact flows: drift[0], kick[0], drift[1], kick[1], ..., drift.back(),
/// each over its share of the time step. A drift moves particles on great circles at constant
/// angular velocity; a kick lets torques and damping change the angular velocities where the
/// particles are.
struct SplittingScheme {
  int order;
  double stability_limit;  ///< of frequency times step
  std::vector<double> drift, kick;
};

const SplittingScheme& splittingScheme(IntegrationMethod method);

/// The scheme to take in place of `scheme` where damping of up to `fastest_rate` [1/s] decays
/// within a step.
const SplittingScheme& schemeUnderDamping(const SplittingScheme& scheme, double fastest_rate,
                                          double time_step);

/// A splitting scheme one spring at a time, by the springs' own formulas: what the faster one is
/// held to.
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

}  // namespace spherical_springs::core
