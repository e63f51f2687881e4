#include "reference/splitting_integrator.h"

#include <utility>

#include "base/parallel.h"

namespace spherical_springs::core::testing {

SplittingIntegrator::SplittingIntegrator(std::shared_ptr<const System> system,
                                         const SplittingScheme& scheme, double time_step)
    : system_(std::move(system)), scheme_(scheme), time_step_(time_step) {}

const SplittingScheme& SplittingIntegrator::schemeFor(const State& state) {
  if (scheme_.order <= 2) return scheme_;
  system_->evaluate(state.positions, workspace_);
  const double rate = system_->damping().fastestRate(workspace_.end_gradients);
  return schemeUnderDamping(scheme_, rate, time_step_);
}

void SplittingIntegrator::stepOnce(State& state) {
  const SplittingScheme& scheme = schemeFor(state);
  for (std::size_t stage = 0; stage < scheme.kick.size(); ++stage) {
    drift(scheme.drift[stage] * time_step_, state);
    kick(scheme.kick[stage] * time_step_, state);
  }
  drift(scheme.drift.back() * time_step_, state);
  countStep(time_step_, state);
}

void SplittingIntegrator::drift(double duration, State& state) const {
  if (duration == 0) return;
  parallelFor(system_->particleCount(), system_->threads(), [&](std::ptrdiff_t i) {
    auto velocity = state.angular_velocities.col(i);
    const Vector3 position = rotated(state.positions.col(i), duration * velocity);
    state.positions.col(i) = position;
    velocity -= position.dot(velocity) * position;  // rounding alone has put it there
  });
}

void SplittingIntegrator::kick(double duration, State& state) {
  system_->evaluate(state.positions, workspace_);
  Points& velocities = state.angular_velocities;
  if (!system_->damping().none()) {
    state.dissipated += system_->damping().kick(state.positions, workspace_.end_gradients,
                                                workspace_.torques, duration, velocities);
    return;
  }
  parallelFor(system_->particleCount(), system_->threads(), [&](std::ptrdiff_t i) {
    velocities.col(i) += duration * system_->inverseMasses()[i] * workspace_.torques.col(i);
  });
}

}  // namespace spherical_springs::core::testing
