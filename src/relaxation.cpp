#include "spherical_springs/relaxation.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <random>
#include <stdexcept>

#include "minimisation/fire.h"
#include "minimisation/newton.h"
#include "spherical_springs/range.h"

namespace spherical_springs::core {
namespace {

using Clock = std::chrono::steady_clock;

std::unique_ptr<Descent> makeDescent(RelaxationMethod method) {
  if (method == RelaxationMethod::dynamics) return std::make_unique<Fire>();
  return std::make_unique<Newton>();
}

/// Whether no direction has negative curvature beyond what `tolerance` [N m] of torque, and
/// rounding, leave open.
bool isMinimum(TangentEnergy& energy, double tolerance) {
  constexpr double kNegligible = 1e-6;  // of the stiffness scale
  return energy.unknowns() == 0 ||
         ShiftedCholesky().factorise(energy, Curvature::exact, kNegligible, tolerance);
}

/// For each particle the longest arc to another particle of its springs, or 1 where all are on one
/// spot [rad].
Eigen::VectorXd reach(const System& system, const Points& positions) {
  Eigen::VectorXd longest = Eigen::VectorXd::Zero(system.particleCount());
  forEachKind([&](auto kind) {
    for (const auto& spring : system.springs<typename decltype(kind)::type>()) {
      for (const std::uint32_t i : spring.particles) {
        for (const std::uint32_t j : spring.particles) {
          longest[i] = std::max(longest[i], arc(positions.col(i), positions.col(j)).angle);
        }
      }
    }
  });
  return (longest.array() > 0).select(longest, 1);
}

/// Displaces every particle by up to a share of its reach, the same way every run.
void displace(const System& system, double share, unsigned seed, TangentEnergy& energy) {
  std::mt19937 generator(seed);
  const Eigen::VectorXd longest = reach(system, energy.positions());
  Points positions = energy.positions();
  for (Eigen::Index i = 0; i < positions.cols(); ++i) {
    Eigen::Vector2d step;
    for (double& component : step) component = generator() / (0.5 * std::mt19937::max()) - 1;
    if (system.pinned(i)) continue;
    const Vector3 p = positions.col(i);
    positions.col(i) = rotated(p, share * longest[i] * (tangentFrame(p) * step));
  }
  energy.moveTo(positions);
}

/// The first spring whose condition is nearly undefined at `positions`, by its place in the order
/// of ids; empty when there is none.
std::string nearlyUndefinedSpring(const System& system, const Points& positions) {
  std::string name;
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    const auto& springs = system.springs<Spring>();
    for (std::size_t i = 0; i < springs.size() && name.empty(); ++i) {
      if (nearlyUndefined(springs[i], System::points(springs[i], positions))) {
        name =
            std::string(Spring::kTable) + "[" + std::to_string(i) + "], with antipodal vertices,";
      }
    }
  });
  return name;
}

/// One relaxation under way.
class Relaxation {
 public:
  Relaxation(const System& system, const Points& positions, const RelaxationOptions& options)
      : system_(system),
        options_(options),
        tolerance_(options.tolerance > 0 ? options.tolerance : defaultTolerance(system)),
        energy_(system, positions),
        first_torque_(energy_.maxTorque()),
        descent_(makeDescent(options.method)) {
    result_.energy_before = energy_.value();
    keep();
  }

  RelaxationResult run() {
    constexpr unsigned kAttempts = 20;
    constexpr unsigned kStuckAttempts = 3;
    unsigned stuck = 0;
    for (unsigned attempt = 0; attempt < kAttempts; ++attempt) {
      const Outcome outcome = descend();
      if (outcome == Outcome::ended) return result_;
      if (outcome == Outcome::within_tolerance && isMinimum(energy_, tolerance_)) {
        keep();
        result_.converged = true;
        result_.message = "converged";
        return result_;
      }
      if (outcome == Outcome::stuck && (atRoundingFloor() || ++stuck > kStuckAttempts)) break;
      displace(system_, std::min(0.1, 1e-3 * std::pow(10, attempt)), attempt, energy_);
      descent_->restart();
    }
    giveUp();
    return result_;
  }

 private:
  enum class Outcome { within_tolerance, stuck, ended };

  Outcome descend() {
    while (energy_.maxTorque() > tolerance_) {
      if (!goOn()) return Outcome::ended;
      const bool moved = descent_->iterate(energy_);
      ++result_.iterations;
      if (isBetter()) keep();
      if (!moved && energy_.maxTorque() > tolerance_) return Outcome::stuck;
    }
    return Outcome::within_tolerance;
  }

  /// Whether the torque is what rounding of the positions makes of the springs' stiffness.
  bool atRoundingFloor() const {
    constexpr double kRounding = 1e-11;
    return energy_.maxTorque() < kRounding * energy_.particleStiffness().maxCoeff();
  }

  /// Lower in energy than what is kept or, where rounding hides that, in torque.
  bool isBetter() const {
    constexpr double kRounding = 1e-13;
    const double drop = result_.energy_after - energy_.value();
    if (std::abs(drop) > kRounding * result_.energy_after) return drop > 0;
    return energy_.maxTorque() < result_.max_torque;
  }

  void keep() {
    result_.positions = energy_.positions();
    result_.energy_after = energy_.value();
    result_.max_torque = energy_.maxTorque();
  }

  bool goOn() {
    const double elapsed = std::chrono::duration<double>(Clock::now() - begin_).count();
    if (options_.max_time > 0 && elapsed >= options_.max_time) {
      result_.message = "max_time is over; largest torque " + toText(result_.max_torque) +
                        " N m, tolerance " + toText(tolerance_) + " N m";
      return false;
    }
    const double way = std::log(first_torque_ / tolerance_);
    const double gone = std::log(first_torque_ / std::max(result_.max_torque, tolerance_));
    const double fraction = way > 0 ? std::clamp(gone / way, 0., 1.) : 1;
    if (options_.go_on({result_, fraction})) return true;
    result_.message = "cancelled; largest torque " + toText(result_.max_torque) + " N m";
    return false;
  }

  void giveUp() {
    if (result_.max_torque <= tolerance_) {
      result_.message = "the torque is within the tolerance, but not at a minimum of the energy";
      return;
    }
    const std::string spring = nearlyUndefinedSpring(system_, result_.positions);
    std::string reason = "rounding ends it";
    if (!spring.empty()) {
      reason = spring + " has no area, which ends it";
    } else if (!atRoundingFloor()) {
      reason = "a long series of them gained next to nothing, which ends it";
    }
    result_.message = "steps lower the energy no further: " + reason + " at a largest torque of " +
                      toText(result_.max_torque) + " N m, above the tolerance of " +
                      toText(tolerance_) + " N m";
  }

  const System& system_;
  const RelaxationOptions& options_;
  const double tolerance_;
  const Clock::time_point begin_ = Clock::now();
  TangentEnergy energy_;
  const double first_torque_;
  std::unique_ptr<Descent> descent_;
  RelaxationResult result_;
};

}  // namespace

RelaxationMethod relaxationMethod(const std::string& name) {
  if (name.empty() || name == "newton") return RelaxationMethod::newton;
  if (name == "dynamics") return RelaxationMethod::dynamics;
  throw std::invalid_argument("method is '" + name + "'; allowed: newton (the default), dynamics");
}

double defaultTolerance(const System& system) { return 1e-9 * system.largestStiffness(); }

RelaxationResult relax(const System& system, const Points& positions,
                       const RelaxationOptions& options) {
  requireInside(Range{0, kLargest, "0 (the default) to 1e30 [N m]"}, options.tolerance,
                "tolerance");
  requireInside(Range{0, kLargest, "0 (no limit) to 1e30 [s]"}, options.max_time, "max_time");
  return Relaxation(system, positions, options).run();
}

}  // namespace spherical_springs::core
