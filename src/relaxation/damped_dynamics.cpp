#include "relaxation/damped_dynamics.h"

#include <algorithm>

#include "stepping/evaluation.h"
#include "stepping/stability.h"

namespace spherical_springs::core {
DampedDynamics::DampedDynamics(const System& system, OrientationGuard* guard,
                               const TorqueLimit& limit)
    : system_(system), guard_(guard), limit_(limit) {}

void DampedDynamics::place(const Points& positions) {
  const std::shared_ptr<const System> not_owned(std::shared_ptr<const System>(), &system_);
  plan_ = std::make_shared<const Plan>(not_owned, positions);
  state_ = {};
  state_.positions = positions;
  allowed_ = allowedTorques(system_, positions, limit_);
  stop();
  measure();
  least_excess_ = excess_;
  least_excess_step_ = 0;
}

void DampedDynamics::stop() {
  state_.angular_velocities.setZero(3, state_.positions.cols());
  kinetic_ = 0;
}

void DampedDynamics::measure() {
  value_ = system_.potential(state_.positions).total();
  const Evaluation here(*plan_, state_.positions);
  auto largest = here.largestTorque(allowed_);
  if (largest.excess <= 1 && limit_.isRelative()) {
    allowed_ = allowedTorques(system_, state_.positions, limit_);
    largest = here.largestTorque(allowed_);
  }
  max_torque_ = largest.torque;
  excess_ = largest.excess;
}

void DampedDynamics::chooseTimeStep() {
  constexpr double kShareOfStable = 0.5;
  constexpr double kLongest = 1e6;  // where nothing swings [s]
  const SplittingScheme& verlet = splittingScheme(IntegrationMethod::verlet);
  const double stable = verlet.stability_limit / highestFrequency(system_, state_.positions);
  integrator_ = std::make_unique<BlockedSplitting>(
      plan_, verlet, std::min(kShareOfStable * stable, kLongest), Passing::ignored);
}

/// Cuts the last step, from `from`, to what the guard allows.
void DampedDynamics::keepOrientation(const Points& from) {
  const Points moves = state_.positions - from;
  Eigen::VectorXd hold = Eigen::VectorXd::Zero(from.cols());
  const double share = guard_->allowedShare(from, moves, hold);
  if (share == 1) return;
  for (Eigen::Index i = 0; i < moves.cols(); ++i) {
    if (moves.col(i).isZero(0)) continue;  // rounding of the length would move it
    state_.positions.col(i) = (from.col(i) + share * moves.col(i)).normalized();
  }
  stop();
}

bool DampedDynamics::iterate() {
  constexpr std::uint64_t kStepLasts = 50;
  constexpr std::uint64_t kPatience = 20000;  // steps in which the excess must fall
  constexpr double kSmaller = 0.999;          // to this share at least
  if (state_.steps % kStepLasts == 0) {
    chooseTimeStep();
    allowed_ = allowedTorques(system_, state_.positions, limit_);
  }
  const Points from = state_.positions;
  integrator_->step(state_);
  const double kinetic = system_.kinetic(state_.angular_velocities);
  if (kinetic < kinetic_) {
    state_.positions = from;
    stop();
  } else {
    kinetic_ = kinetic;
    if (guard_) keepOrientation(from);
  }
  measure();
  if (excess_ < kSmaller * least_excess_) {
    least_excess_ = excess_;
    least_excess_step_ = state_.steps;
  }
  return state_.steps - least_excess_step_ < kPatience;
}

}  // namespace spherical_springs::core
