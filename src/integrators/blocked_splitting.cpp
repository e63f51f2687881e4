#include "blocked_splitting.h"

namespace spherical_springs::core {

BlockedSplitting::BlockedSplitting(const std::shared_ptr<const System>& system,
                                   const SplittingScheme& scheme, double time_step,
                                   const StepKernels& kernels)
    : scheme_(schemeUnderDamping(scheme, system->damping(), {}, time_step)),
      time_step_(time_step),
      motion_(system, system->layout(), kernels) {}

void BlockedSplitting::take(const State& state) {
  motion_.take(state);
  progress_ = state;
}

void BlockedSplitting::give(State& state) const {
  motion_.give(state);
  static_cast<Progress&>(state) = progress_;
}

// The first drift of a step is done together with the last one of the step before, but as a drift
// of its own, so that the bits do not tell.
void BlockedSplitting::advance(std::uint64_t steps) {
  if (steps == 0) return;
  const double first_drift = scheme_.drift[0] * time_step_;
  if (first_drift != 0) motion_.drift(first_drift);
  for (; steps > 1; --steps) stepOnce(first_drift);
  stepOnce(0);
}

void BlockedSplitting::stepOnce(double next_drift) {
  const std::size_t stages = scheme_.kick.size();
  for (std::size_t stage = 0; stage < stages; ++stage) {
    const double drift = scheme_.drift[stage + 1] * time_step_;
    progress_.dissipated += motion_.kickAndDrift(scheme_.kick[stage] * time_step_,
                                                 {drift, stage + 1 < stages ? 0 : next_drift});
  }
  countStep(time_step_, progress_);
}

}  // namespace spherical_springs::core
