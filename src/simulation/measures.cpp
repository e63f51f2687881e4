#include "spherical_springs/measures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "spherical_springs/range.h"
#include "stepping/evaluation.h"

namespace spherical_springs::core {

Energies energies(const System& system, const State& state) {
  Energies result;
  result.by_kind = Evaluation(system, state.positions).potential();
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
  return Evaluation(system, state.positions).maxTorque();
}

double normError(const State& state) {
  if (state.positions.cols() == 0) return 0;
  return (state.positions.colwise().norm().array() - 1).abs().maxCoeff();
}

namespace {

/// Adds the blocks of a spring's stiffness, in units of acceleration, to the sums of its particles:
/// those on the diagonal as they are, the norms of the others.
template <class Spring>
void addCircles(const Spring& spring, const System& system, const Points& positions,
                std::vector<Eigen::Matrix2d>& diagonal, Eigen::VectorXd& others) {
  constexpr std::size_t N = Spring::kParticles;
  const auto points = System::points(spring, positions);
  std::array<TangentFrame, N> frames;
  for (std::size_t j = 0; j < N; ++j) frames[j] = tangentFrame(points[j]);
  const auto c = tangentCondition(spring, points, frames, Curvature::exact);
  for (std::size_t i = 0; i < N; ++i) {
    const std::uint32_t row = spring.particles[i];
    for (std::size_t j = 0; j < N; ++j) {
      const std::uint32_t column = spring.particles[j];
      const double mobility =
          std::sqrt(system.inverseMasses()[row] * system.inverseMasses()[column]);
      const Eigen::Matrix2d block =
          spring.stiffness * mobility *
          (c.gradient[i] * c.gradient[j].transpose() + c.value * c.hessian[i][j]);
      if (i == j) {
        diagonal[row] += block;
      } else {
        others[row] += block.norm();
      }
    }
  }
}

double largestEigenvalue(const Eigen::Matrix2d& m) {
  const double difference = (m(0, 0) - m(1, 1)) / 2;
  return (m(0, 0) + m(1, 1)) / 2 + std::hypot(difference, m(0, 1));
}

}  // namespace

double highestFrequency(const System& system, const Points& positions) {
  std::vector<Eigen::Matrix2d> diagonal(system.particleCount(), Eigen::Matrix2d::Zero());
  Eigen::VectorXd others = Eigen::VectorXd::Zero(system.particleCount());
  forEachKind([&](auto kind) {
    for (const auto& spring : system.springs<typename decltype(kind)::type>()) {
      addCircles(spring, system, positions, diagonal, others);
    }
  });
  double squared = 0;
  for (Eigen::Index i = 0; i < system.particleCount(); ++i) {
    squared = std::max(squared, largestEigenvalue(diagonal[i]) + others[i]);
  }
  return std::sqrt(squared);
}

double stableTimeStep(const System& system, IntegrationMethod method, const Points& positions) {
  const double limit = stabilityLimit(method);
  // A frequency may be infinite too.
  return std::isinf(limit) ? limit : limit / highestFrequency(system, positions);
}

double localError(const std::shared_ptr<const System>& system, IntegrationMethod method,
                  double time_step, const State& state) {
  if (state.positions.cols() == 0) return 0;
  State whole = state;
  makeIntegrator(system, method, time_step)->step(whole);
  State halves = state;
  const auto half = makeIntegrator(system, method, time_step / 2);
  half->step(halves);
  half->step(halves);
  const double difference = (whole.positions - halves.positions).colwise().norm().maxCoeff();
  return difference / (1 - std::pow(2., -orderOf(method)));
}

namespace {

/// Whether the energy has gone astray, by more than rounding can do to springs that are all but at
/// rest.
bool blownUp(const Measures& measures, IntegrationMethod method, const System& system,
             const Energies& now) {
  constexpr double kAstray = 0.1;      // of the energy
  constexpr double kRounding = 1e-20;  // [rad^2] or [sr^2]
  if (!std::isfinite(now.total())) return true;
  const bool takes_energy_out = method == IntegrationMethod::implicit_euler;
  return !takes_energy_out && measures.energy_error > kAstray &&
         now.total() > kRounding * system.largestStiffness();
}

std::string warningOf(const Measures& measures, double time_step, const State& state) {
  if (state.unconverged_steps > 0) {
    return std::to_string(state.unconverged_steps) +
           " steps of implicit_euler ended before their minimum, where rounding or a triangle "
           "without area stopped them: they are sound, but less exact";
  }
  if (measures.blown_up) {
    return "the energy is off by " + toText(std::round(100 * measures.energy_error)) +
           " % since the account began: the time step of " + toText(time_step) +
           " s is too long for this scene (stable here: " + toText(measures.stable_time_step) +
           " s)";
  }
  if (time_step > measures.stable_time_step) {
    return "the time step of " + toText(time_step) + " s is above the stable one, " +
           toText(measures.stable_time_step) + " s";
  }
  return "";
}

}  // namespace

Measures measure(const std::shared_ptr<const System>& system, IntegrationMethod method,
                 double time_step, const State& state, Account& account) {
  Measures result;
  result.stable_time_step = stableTimeStep(*system, method, state.positions);
  result.local_error = localError(system, method, time_step, state);
  const Energies now = energies(*system, state);
  result.energy_error = account.energyError(now);
  result.angular_momentum_error = account.angularMomentumError(*system, state);
  result.norm_error = normError(state);
  result.max_torque = maxTorque(*system, state);
  result.blown_up = blownUp(result, method, *system, now);
  result.warning = warningOf(result, time_step, state);
  return result;
}

}  // namespace spherical_springs::core
