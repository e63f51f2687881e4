#include "damped_dynamics.h"

#include <algorithm>

namespace spherical_springs::core {
namespace {

constexpr IntegrationMethod kMethod = IntegrationMethod::verlet;

}  // namespace

DampedDynamics::DampedDynamics(const System& system, OrientationGuard* guard)
    : system_(std::shared_ptr<const System>(), &system), guard_(guard) {}

void DampedDynamics::place(const Points& positions) {
  state_ = {};
  state_.positions = positions;
  stop();
  measure();
  least_torque_ = max_torque_;
  least_torque_step_ = 0;
}

void DampedDynamics::stop() {
  state_.angular_velocities.setZero(3, state_.positions.cols());
  kinetic_ = 0;
}

void DampedDynamics::measure() {
  value_ = system_->potential(state_.positions).total();
  max_torque_ = core::maxTorque(*system_, state_);
}

void DampedDynamics::chooseTimeStep() {
  constexpr double kShareOfStable = 0.5;
  constexpr double kLongest = 1e6;  // where nothing swings [s]
  const double stable = stableTimeStep(*system_, kMethod, state_.positions);
  integrator_ = makeIntegrator(system_, kMethod, std::min(kShareOfStable * stable, kLongest));
}

/// Cuts the last step, from `from`, to what the guard allows.
void DampedDynamics::keepOrientation(const Points& from) {
  const Points moves = state_.positions - from;
  Eigen::VectorXd hold = Eigen::VectorXd::Zero(from.cols());
  const double share = guard_->allowedShare(from, moves, hold);
  if (share == 1) return;
  state_.positions = (from + share * moves).colwise().normalized();
  stop();
}

bool DampedDynamics::iterate() {
  constexpr std::uint64_t kStepLasts = 50;
  constexpr std::uint64_t kPatience = 20000;  // steps without a smaller torque
  if (state_.steps % kStepLasts == 0) chooseTimeStep();
  const Points from = state_.positions;
  integrator_->step(state_);
  const double kinetic = system_->kinetic(state_.angular_velocities);
  if (kinetic < kinetic_) {
    state_.positions = from;
    stop();
  } else {
    kinetic_ = kinetic;
    if (guard_) keepOrientation(from);
  }
  measure();
  if (max_torque_ < least_torque_) {
    least_torque_ = max_torque_;
    least_torque_step_ = state_.steps;
  }
  return state_.steps - least_torque_step_ < kPatience;
}

}  // namespace spherical_springs::core
