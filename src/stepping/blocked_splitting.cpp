#include "stepping/blocked_splitting.h"

#include <utility>

namespace spherical_springs::core {
namespace {

/// As far as viscous damping can tell once and for all.
const SplittingScheme& schemeFor(const System& system, const SplittingScheme& scheme,
                                 double time_step) {
  if (system.damping().hasDampers()) return scheme;
  return schemeUnderDamping(scheme, system.damping().fastestRate({}), time_step);
}

}  // namespace

BlockedSplitting::BlockedSplitting(std::shared_ptr<const Plan> plan, const SplittingScheme& scheme,
                                   double time_step, const StepKernels& kernels)
    : scheme_(schemeFor(*plan->system(), scheme, time_step)),
      time_step_(time_step),
      depends_on_rates_(scheme.order > 2 && plan->system()->damping().hasDampers()),
      motion_(std::move(plan), kernels) {
  prepare(scheme_);
  if (depends_on_rates_) prepare(splittingScheme(IntegrationMethod::verlet));
}

void BlockedSplitting::prepare(const SplittingScheme& scheme) {
  for (const double kick : scheme.kick) motion_.prepareKick(kick * time_step_);
}

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
  if (depends_on_rates_) return advanceByRates(steps);
  const double first_drift = scheme_.drift[0] * time_step_;
  if (first_drift != 0) motion_.drift(first_drift);
  for (; steps > 1; --steps) stepOnce(scheme_, first_drift);
  stepOnce(scheme_, 0);
}

void BlockedSplitting::advanceByRates(std::uint64_t steps) {
  for (; steps > 0; --steps) {
    const SplittingScheme& scheme = schemeUnderDamping(scheme_, motion_.fastestRate(), time_step_);
    if (scheme.drift[0] != 0) motion_.drift(scheme.drift[0] * time_step_);
    stepOnce(scheme, 0);
  }
}

void BlockedSplitting::stepOnce(const SplittingScheme& scheme, double next_drift) {
  const std::size_t stages = scheme.kick.size();
  for (std::size_t stage = 0; stage < stages; ++stage) {
    const double drift = scheme.drift[stage + 1] * time_step_;
    progress_.dissipated += motion_.kickAndDrift(scheme.kick[stage] * time_step_,
                                                 {drift, stage + 1 < stages ? 0 : next_drift});
  }
  countStep(time_step_, progress_);
}

}  // namespace spherical_springs::core
