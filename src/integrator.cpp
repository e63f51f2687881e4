#include "spherical_springs/integrator.h"

#include <stdexcept>
#include <utility>

#include "parallel.h"

namespace spherical_springs::core {

const SplittingScheme& splittingScheme(const std::string& name) {
  static const std::vector<SplittingScheme> schemes = {
      {"euler", 1, {0, 1}, {1}},
      {"verlet", 2, {0.5, 0.5}, {1}},
  };
  for (const SplittingScheme& scheme : schemes) {
    if (scheme.name == name) return scheme;
  }
  throw std::invalid_argument("integrator is '" + name + "'; allowed: euler, verlet");
}

Integrator::Integrator(std::shared_ptr<const System> system, const SplittingScheme& scheme,
                       double time_step)
    : system_(std::move(system)), scheme_(scheme), time_step_(time_step) {}

void Integrator::step(State& state) {
  for (std::size_t stage = 0; stage < scheme_.kick.size(); ++stage) {
    drift(scheme_.drift[stage] * time_step_, state);
    kick(scheme_.kick[stage] * time_step_, state);
  }
  drift(scheme_.drift.back() * time_step_, state);
  ++state.steps;
  state.time += time_step_;
}

void Integrator::drift(double duration, State& state) const {
  if (duration == 0) return;
  parallelFor(system_->particleCount(), system_->threads(), [&](std::ptrdiff_t i) {
    auto velocity = state.angular_velocities.col(i);
    const Vector3 position = rotated(state.positions.col(i), duration * velocity);
    state.positions.col(i) = position;
    velocity -= position.dot(velocity) * position;  // rounding alone has put it there
  });
}

void Integrator::kick(double duration, State& state) {
  system_->evaluate(state.positions, workspace_);
  Points& velocities = state.angular_velocities;
  if (!system_->damping().none()) {
    state.dissipated +=
        system_->damping().kick(workspace_.end_gradients, workspace_.torques, duration, velocities);
    return;
  }
  parallelFor(system_->particleCount(), system_->threads(), [&](std::ptrdiff_t i) {
    velocities.col(i) += duration * system_->inverseMasses()[i] * workspace_.torques.col(i);
  });
}

}  // namespace spherical_springs::core
