#include "spherical_springs/measures.h"

#include <algorithm>
#include <cmath>

namespace spherical_springs::core {

Energies energies(const System& system, const State& state) {
  Energies result;
  result.by_kind = system.potential(state.positions);
  result.kinetic = system.kinetic(state.angular_velocities);
  result.dissipated = state.dissipated;
  return result;
}

namespace {

double sumOfMomenta(const System& system, const State& state) {
  return state.angular_velocities.colwise().norm().dot(system.masses().transpose());
}

}  // namespace

Account::Account(const System& system, const State& state)
    : energy_(energies(system, state).total() + state.dissipated),
      momentum_(system.angularMomentum(state.angular_velocities)),
      largest_total_(energy_ - state.dissipated),
      largest_momentum_(sumOfMomenta(system, state)) {}

double Account::energyError(const Energies& now) {
  const std::lock_guard<std::mutex> lock(mutex_);
  largest_total_ = std::max(largest_total_, now.total());
  if (largest_total_ == 0) return 0;
  return std::abs(now.total() + now.dissipated - energy_) / largest_total_;
}

double Account::angularMomentumError(const System& system, const State& state) {
  if (!system.conservesAngularMomentum()) return 0;
  const double sum = sumOfMomenta(system, state);
  const Vector3 change = system.angularMomentum(state.angular_velocities) - momentum_;
  const std::lock_guard<std::mutex> lock(mutex_);
  largest_momentum_ = std::max(largest_momentum_, sum);
  return largest_momentum_ > 0 ? change.norm() / largest_momentum_ : 0;
}

double maxTorque(const System& system, const State& state) {
  System::Workspace workspace;
  system.evaluate(state.positions, workspace);
  double largest = 0;
  for (Eigen::Index i = 0; i < system.particleCount(); ++i) {
    if (!system.pinned(i)) largest = std::max(largest, workspace.torques.col(i).norm());
  }
  return largest;
}

double normError(const State& state) {
  if (state.positions.cols() == 0) return 0;
  return (state.positions.colwise().norm().array() - 1).abs().maxCoeff();
}

double stableTimeStep(const System& system, const Points& positions) {
  const Eigen::VectorXd roots = system.inverseMasses().cwiseSqrt();
  Eigen::VectorXd rows = Eigen::VectorXd::Zero(system.particleCount());
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    for (const Spring& spring : system.springs<Spring>()) {
      const auto c = condition(spring, System::points(spring, positions));
      double coupling = 0;
      for (std::size_t j = 0; j < Spring::kParticles; ++j) {
        coupling += c.gradient[j].norm() * roots[spring.particles[j]];
      }
      for (std::size_t j = 0; j < Spring::kParticles; ++j) {
        const std::uint32_t particle = spring.particles[j];
        rows[particle] += spring.stiffness * c.gradient[j].norm() * roots[particle] * coupling;
      }
    }
  });
  const double squared_frequency = rows.size() > 0 ? rows.maxCoeff() : 0;
  return squared_frequency > 0 ? 2 / std::sqrt(squared_frequency) : 0;
}

double localError(const std::shared_ptr<const System>& system, const SplittingScheme& scheme,
                  double time_step, const State& state) {
  if (state.positions.cols() == 0) return 0;
  State whole = state;
  Integrator(system, scheme, time_step).step(whole);
  State halves = state;
  Integrator half(system, scheme, time_step / 2);
  half.step(halves);
  half.step(halves);
  const double difference = (whole.positions - halves.positions).colwise().norm().maxCoeff();
  return difference / (1 - std::pow(2., -scheme.order));
}

}  // namespace spherical_springs::core
