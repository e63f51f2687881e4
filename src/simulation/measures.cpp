#include "spherical_springs/measures.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "base/rounded.h"
#include "simulation/error_rate.h"
#include "spherical_springs/range.h"
#include "stepping/evaluation.h"
#include "stepping/stability.h"

namespace spherical_springs::core {

Energies energies(const Plan& plan, const State& state) {
  Energies result;
  result.by_kind = Evaluation(plan, state.positions).potential();
  result.kinetic = plan.system()->kinetic(state.angular_velocities);
  result.dissipated = state.dissipated;
  return result;
}

namespace {

double sumOfMomenta(const System& system, const State& state) {
  return state.angular_velocities.colwise().norm().dot(system.masses().transpose());
}

/// Rounding of angles and solid angles may change the energy of a spring by this times its
/// stiffness [rad^2] or [sr^2].
constexpr double kRounding = 1e-20;

}  // namespace

Account::Account(const Plan& plan, const State& state)
    : energy_(energies(plan, state).total() + state.dissipated),
      scale_(std::max(energy_ - state.dissipated, kRounding * plan.system()->largestStiffness())),
      momentum_(plan.system()->angularMomentum(state.angular_velocities)),
      first_step_(state.steps),
      largest_momentum_(sumOfMomenta(*plan.system(), state)) {}

double Account::energyError(const Energies& now) const {
  const double change = std::abs(now.total() + now.dissipated - energy_);
  return change == 0 ? 0 : change / scale_;
}

double Account::dividedSteps(const Progress& now) const {
  const std::uint64_t steps = now.steps - first_step_;
  return steps == 0 ? 0 : static_cast<double>(now.divided_steps) / steps;
}

double Account::angularMomentumError(const System& system, const State& state) {
  if (!system.conservesAngularMomentum()) return 0;
  const double sum = sumOfMomenta(system, state);
  const Vector3 change = system.angularMomentum(state.angular_velocities) - momentum_;
  const std::lock_guard<std::mutex> lock(mutex_);
  largest_momentum_ = std::max(largest_momentum_, sum);
  return largest_momentum_ > 0 ? change.norm() / largest_momentum_ : 0;
}

Strains strains(const System& system, const Points& positions) {
  Strains strains;
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    const auto& springs = system.springs<Spring>();
    auto& [conditions, energies] = strains.get<Spring>();
    conditions.resize(springs.size());
    energies.resize(springs.size());
    for (std::size_t s = 0; s < springs.size(); ++s) {
      const double c = condition(springs[s], System::points(springs[s], positions)).value;
      conditions[s] = c;
      energies[s] = 0.5 * springs[s].stiffness * c * c;
    }
  });
  return strains;
}

double maxTorque(const Plan& plan, const State& state) {
  return Evaluation(plan, state.positions).maxTorque();
}

double normError(const State& state) {
  if (state.positions.cols() == 0) return 0;
  return (state.positions.colwise().norm().array() - 1).abs().maxCoeff();
}

double stableTimeStep(const System& system, IntegrationMethod method, const Points& positions) {
  return stabilityLimit(method) / highestFrequency(system, positions);
}

namespace {

/// Returns how many steps a window of trial steps may have, to take some milliseconds: fewer in
/// larger scenes, and few where each is a minimisation.
int mostTrialSteps(const System& system, IntegrationMethod method) {
  constexpr double kWork = 1e6;  // particles and springs, by steps
  constexpr int kFewest = 16, kMost = 256, kImplicit = 8;
  if (method == IntegrationMethod::implicit_euler) return kImplicit;
  double size = static_cast<double>(system.particleCount());
  forEachKind([&](auto kind) {
    size += static_cast<double>(system.springs<typename decltype(kind)::type>().size());
  });
  return static_cast<int>(std::clamp<double>(kWork / size, kFewest, kMost));
}

}  // namespace

double errorRate(const std::shared_ptr<const Plan>& plan, IntegrationMethod method,
                 double time_step, const State& state) {
  const int most_steps = mostTrialSteps(*plan->system(), method);
  return ErrorProbe(plan, state, most_steps).errorRate(method, time_step);
}

namespace {

/// Whether the energy has gone astray, by more than rounding can do to springs that are all but at
/// rest.
bool blownUp(const Measures& measures, IntegrationMethod method, const Energies& now) {
  constexpr double kAstray = 0.1;  // of the energy
  if (!std::isfinite(now.total())) return true;
  return !takesEnergyOut(method) && measures.energy_error > kAstray;
}

/// Returns a share in percent with two significant digits, below 1e6 % without an exponent.
std::string percentOf(double share) {
  const double percent = rounded(100 * share);
  if (!(percent < 1e6)) return toText(percent);
  char text[32];
  std::snprintf(text, sizeof text, "%.0f", percent);
  return text;
}

/// Returns what the passage with the shortest step was; empty where there was none.
std::string passageIn(const Passage& shortest) {
  if (shortest.substep == 0) return "";
  return std::string(shortest.kind) + " " + std::to_string(shortest.spring_id) + " passed " +
         roundedText(shortest.distance) + " from " + shortest.place +
         " at t = " + toText(shortest.time) + " s";
}

std::string warningOf(const Measures& measures, double time_step, const State& state) {
  if (state.unconverged_steps > 0) {
    return std::to_string(state.unconverged_steps) +
           " steps of implicit_euler ended before their minimum, where rounding or a triangle "
           "without area stopped them: they are sound, but less exact";
  }
  const std::string step = "the time step of " + toText(time_step) + " s";
  const std::string stable = toText(measures.stable_time_step) + " s";
  if (measures.blown_up) {
    const std::string off =
        "the energy is off by " + percentOf(measures.energy_error) + " % since the account began";
    if (time_step > measures.stable_time_step) {
      return off + ": " + step + " is too long for this scene (stable here: " + stable + ")";
    }
    const std::string passed = passageIn(state.shortest);
    return off + ", though " + step + " is below the stable one here, " + stable +
           (passed.empty() ? "" : ": " + passed + "; such passages are shorter than any step") +
           "; a shorter step, or fourth_order, keeps it better";
  }
  if (time_step > measures.stable_time_step) {
    return step + " is above the stable one, " + stable;
  }
  return "";
}

}  // namespace

Measures measure(const std::shared_ptr<const Plan>& plan, IntegrationMethod method,
                 double time_step, const State& state, Account& account) {
  const System& system = *plan->system();
  Measures result;
  result.stable_time_step = stableTimeStep(system, method, state.positions);
  result.error_rate = errorRate(plan, method, time_step, state);
  result.local_error = result.error_rate * time_step;
  const Energies now = energies(*plan, state);
  result.energy_error = account.energyError(now);
  result.angular_momentum_error = account.angularMomentumError(system, state);
  result.norm_error = normError(state);
  result.max_torque = maxTorque(*plan, state);
  result.divided_steps = account.dividedSteps(state);
  result.shortest_substep = state.shortest.substep;
  result.blown_up = blownUp(result, method, now);
  result.warning = warningOf(result, time_step, state);
  return result;
}

}  // namespace spherical_springs::core
