#include "relaxation/implicit_euler.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace spherical_springs::core {

ImplicitEuler::ImplicitEuler(std::shared_ptr<const System> system, double time_step)
    : system_(std::move(system)),
      time_step_(time_step),
      inertia_(system_->masses() / (time_step * time_step)) {}

void ImplicitEuler::stepOnce(State& state) {
  const double before = system_->potential(state.positions).total() +
                        system_->kinetic(state.angular_velocities) + state.dissipated;
  damp(state);
  const Points targets = inertialPositions(state);
  if (!minimise(state.positions, targets)) ++state.unconverged_steps;
  takeVelocities(targets, state);
  boundEnergy(before - state.dissipated, state);
  countStep(time_step_, state);
}

void ImplicitEuler::damp(State& state) {
  if (system_->damping().none()) return;
  system_->evaluate(state.positions, workspace_);
  workspace_.torques.setZero();
  state.dissipated +=
      system_->damping().kick(state.positions, workspace_.end_gradients, workspace_.torques,
                              time_step_, state.angular_velocities);
}

Points ImplicitEuler::inertialPositions(const State& state) const {
  Points targets = state.positions;
  for (Eigen::Index i = 0; i < targets.cols(); ++i) {
    targets.col(i) = rotated(targets.col(i), time_step_ * state.angular_velocities.col(i));
  }
  return targets;
}

/// Moves the positions to the minimum of the energy, or as near as they come.
/// @return whether the minimum was reached.
bool ImplicitEuler::minimise(Points& positions, const Points& targets) {
  try {
    const bool reached = descend(positions, targets);
    positions = newton_->positions();
    return reached;
  } catch (...) {
    newton_.reset();  // left in the middle of an iteration
    throw;
  }
}

bool ImplicitEuler::descend(const Points& positions, const Points& targets) {
  constexpr int kMostIterations = 100;
  constexpr double kTolerance = 1e-10, kRoundingTolerance = 1e-6;  // of the torque at the start
  if (!newton_) newton_ = std::make_unique<Newton>(*system_, positions, inertia_);
  newton_->setTargets(targets);
  newton_->place(positions);
  const double at_positions = newton_->value();
  const double scale = newton_->maxTorque();
  newton_->place(targets);
  if (newton_->value() > at_positions) newton_->place(positions);
  for (int i = 0; i < kMostIterations; ++i) {
    if (newton_->maxTorque() <= kTolerance * scale) return true;
    if (!newton_->iterate()) break;
  }
  return newton_->maxTorque() <= kRoundingTolerance * scale;
}

// On a plane the new velocity would be that of the inertial position, plus the way from there over
// the step. Here the sum is taken as it stands, so that free spinning goes on however large the
// step, and its part along the position dropped, so that a scene which is saved and read keeps it.
void ImplicitEuler::takeVelocities(const Points& targets, State& state) const {
  for (Eigen::Index i = 0; i < targets.cols(); ++i) {
    if (system_->pinned(i)) continue;
    const Vector3 position = state.positions.col(i);
    const Arc way = arc(targets.col(i), position);
    Vector3 velocity = state.angular_velocities.col(i);
    velocity += way.angle / time_step_ * way.axis;
    state.angular_velocities.col(i) = tangentPart(position, velocity);
  }
}

// The minimum bounds the energy by a multiple only where the springs' energy is not convex; the
// velocities are cut back to what was there.
void ImplicitEuler::boundEnergy(double most, State& state) const {
  const double kinetic = system_->kinetic(state.angular_velocities);
  const double allowed = most - system_->potential(state.positions).total();
  if (kinetic <= allowed || kinetic == 0) return;
  const double factor = std::sqrt(std::max(allowed, 0.) / kinetic);
  for (Eigen::Index i = 0; i < state.positions.cols(); ++i) {
    const Vector3 velocity = factor * state.angular_velocities.col(i);
    state.angular_velocities.col(i) = tangentPart(state.positions.col(i), velocity);
  }
}

}  // namespace spherical_springs::core
