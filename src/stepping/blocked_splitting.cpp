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
                                   double time_step, Passing passing, const StepKernels& kernels)
    : scheme_(schemeFor(*plan->system(), scheme, time_step)),
      time_step_(time_step),
      depends_on_rates_(scheme.order > 2 && plan->system()->damping().hasDampers()),
      motion_(plan, kernels),
      resolves_passages_(passing == Passing::resolved),
      plan_(std::move(plan)) {
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

void BlockedSplitting::advance(std::uint64_t steps) {
  if (steps == 0) return;
  if (!resolves_passages_) return advanceAtOnce(steps);
  motion_.copyTo(before_);
  const Progress progress = progress_;
  try {
    advanceAtOnce(steps);
  } catch (...) {
    motion_.putBack(before_);
    progress_ = progress;
    throw;
  }
}

// The first drift of a step is done together with the last one of the step before, but as a drift
// of its own, so that the bits do not tell.
void BlockedSplitting::advanceAtOnce(std::uint64_t steps) {
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
  if (was_near_ || !stepFarFromAll(scheme, next_drift)) stepThroughEncounters(scheme, next_drift);
  countStep(time_step_, progress_);
}

/// @return false where springs may be near places without derivative, and nothing has happened.
bool BlockedSplitting::stepFarFromAll(const SplittingScheme& scheme, double next_drift) {
  const std::size_t stages = scheme.kick.size();
  if (resolves_passages_ && stages > 1) motion_.copyTo(drifted_);
  double dissipated = 0;
  for (std::size_t stage = 0; stage < stages; ++stage) {
    const double drift = scheme.drift[stage + 1] * time_step_;
    const auto taken =
        motion_.kickAndDrift(scheme.kick[stage] * time_step_,
                             {drift, stage + 1 < stages ? 0 : next_drift}, resolves_passages_);
    if (!taken) {
      if (stages > 1) motion_.putBack(drifted_);
      return false;
    }
    dissipated += *taken;
  }
  progress_.dissipated += dissipated;
  return true;
}

namespace {

/// Returns which part of a drift groups do under their springs. The report's scheme is verlet, seen
/// half a step later.
double shareUnderSprings(const SplittingScheme& scheme) { return scheme.order == 1 ? 0.5 : 1; }

double firstDriftOf(const SplittingScheme& scheme) {
  return scheme.order == 1 ? 0.5 : scheme.drift[0];
}

}  // namespace

// The first drift of the step has been done for all particles, so that it is done again for those
// of springs that ask. Each spring that is new among them lets the step begin again, as in
// `Passages::step`.
void BlockedSplitting::stepThroughEncounters(const SplittingScheme& scheme, double next_drift) {
  if (encounters_ == nullptr) {
    encounters_ = std::make_unique<Encounters>(*plan_->system(), plan_->layout().patches().size(),
                                               time_step_);
  }
  encounters_->begin(scheme);
  motion_.copyTo(drifted_);
  for (;;) {
    const double first = passFirstKick(scheme);
    if (const auto others = passOtherKicks(scheme)) {
      progress_.dissipated += first + *others;
      break;
    }
    motion_.putBack(drifted_);
    encounters_->expectChange();
    encounters_->enter(firstDriftOf(scheme) * time_step_, drifted_, motion_);
  }
  if (next_drift != 0) motion_.drift(next_drift);
  if (encounters_->anyAsked()) countPassages();
}

/// @return the energy that damping took out [J].
double BlockedSplitting::passFirstKick(const SplittingScheme& scheme) {
  for (;;) {
    motion_.copyTo(entered_);
    const double dissipated = motion_.kick(scheme.kick[0] * time_step_, encounters_->leftOut());
    was_near_ = motion_.isNear();
    if (!encounters_->ask(motion_, entered_)) return dissipated;
    motion_.putBack(entered_);
    encounters_->enter(firstDriftOf(scheme) * time_step_, drifted_, motion_);
  }
}

/// @return the energy that damping took out [J]; none where a spring asks that has not asked
/// before.
std::optional<double> BlockedSplitting::passOtherKicks(const SplittingScheme& scheme) {
  double dissipated = 0;
  for (std::size_t stage = 1; stage < scheme.kick.size(); ++stage) {
    driftPast(scheme, stage);
    motion_.copyTo(entered_);
    dissipated += motion_.kick(scheme.kick[stage] * time_step_, encounters_->leftOut());
    was_near_ |= motion_.isNear();
    encounters_->expectChange();
    if (encounters_->ask(motion_, entered_)) return std::nullopt;
  }
  driftPast(scheme, scheme.kick.size());
  return dissipated;
}

void BlockedSplitting::driftPast(const SplittingScheme& scheme, std::size_t stage) {
  const double duration = scheme.drift[stage] * time_step_;
  encounters_->drift(duration, shareUnderSprings(scheme) * duration, motion_);
}

void BlockedSplitting::countPassages() {
  ++progress_.divided_steps;
  Passage shortest = encounters_->shortest();
  shortest.time = progress_.time;
  if (progress_.shortest.substep == 0 || shortest.substep < progress_.shortest.substep) {
    progress_.shortest = shortest;
  }
}

}  // namespace spherical_springs::core
