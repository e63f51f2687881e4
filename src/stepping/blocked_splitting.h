#pragma once

#include <memory>

#include "stepping/motion.h"
#include "stepping/splitting.h"

namespace spherical_springs::core {

/// A splitting scheme block by block, several springs at a time. All memory is taken when it is
/// made, so that no step can fail.
class BlockedSplitting : public Integrator {
 public:
  BlockedSplitting(std::shared_ptr<const Plan> plan, const SplittingScheme& scheme,
                   double time_step, const StepKernels& kernels = stepKernels());
  void take(const State& state) override;
  void advance(std::uint64_t steps) override;
  void give(State& state) const override;

 private:
  void prepare(const SplittingScheme& scheme);
  void advanceByRates(std::uint64_t steps);
  void stepOnce(const SplittingScheme& scheme, double next_drift);

  const SplittingScheme& scheme_;
  double time_step_;
  bool depends_on_rates_;  // of damped springs
  Motion motion_;
  Progress progress_;
};

}  // namespace spherical_springs::core
