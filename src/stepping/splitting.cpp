#include "stepping/splitting.h"

#include <utility>

#include "base/parallel.h"

namespace spherical_springs::core {
namespace {

// The six-stage scheme S6 of fourth order of S. Blanes and P. C. Moan, "Practical symplectic
// partitioned Runge-Kutta and Runge-Kutta-Nystrom methods", J. Comput. Appl. Math. 142 (2002),
// 313-330, table 2. Its stability limit follows from the trace of a step of an oscillator.
SplittingScheme blanesMoan() {
  constexpr double a1 = 0.0792036964311957, a2 = 0.353172906049774, a3 = -0.0420650803577195;
  constexpr double b1 = 0.209515106613362, b2 = -0.143851773179818;
  constexpr double a4 = 1 - 2 * (a1 + a2 + a3), b3 = 0.5 - (b1 + b2);
  return {4, 3.13, {a1, a2, a3, a4, a3, a2, a1}, {b1, b2, b3, b3, b2, b1}};
}

}  // namespace

const SplittingScheme& splittingScheme(IntegrationMethod method) {
  static const SplittingScheme kEuler = {1, 2, {0, 1}, {1}};
  static const SplittingScheme kVerlet = {2, 2, {0.5, 0.5}, {1}};
  static const SplittingScheme kFourthOrder = blanesMoan();
  if (method == IntegrationMethod::euler) return kEuler;
  return method == IntegrationMethod::verlet ? kVerlet : kFourthOrder;
}

// Above second order some kicks go back in time, and damping with them: where it decays within a
// step that would amplify it without bound. A verlet step is stable there.
const SplittingScheme& schemeUnderDamping(const SplittingScheme& scheme, double fastest_rate,
                                          double time_step) {
  if (scheme.order <= 2 || fastest_rate * time_step <= 1) return scheme;
  return splittingScheme(IntegrationMethod::verlet);
}

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

}  // namespace spherical_springs::core
