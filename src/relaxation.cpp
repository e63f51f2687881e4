#include "spherical_springs/relaxation.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <random>
#include <stdexcept>

#include "alignment.h"
#include "minimisation/damped_dynamics.h"
#include "minimisation/fire.h"
#include "minimisation/newton.h"
#include "minimisation/particle_stiffness.h"
#include "spherical_springs/range.h"

namespace spherical_springs::core {
namespace {

using Clock = std::chrono::steady_clock;

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

/// Every particle displaced by up to a share of its reach, the same way every run.
Points displaced(const System& system, Points positions, double share, unsigned seed) {
  std::mt19937 generator(seed);
  const Eigen::VectorXd longest = reach(system, positions);
  for (Eigen::Index i = 0; i < positions.cols(); ++i) {
    Eigen::Vector2d step;
    for (int k = 0; k < 2; ++k) step[k] = generator() / (0.5 * std::mt19937::max()) - 1;
    if (system.pinned(i)) continue;
    const Vector3 p = positions.col(i);
    positions.col(i) = rotated(p, share * longest[i] * (tangentFrame(p) * step));
  }
  return positions;
}

/// A spring by its place in the order of ids.
template <class Spring>
std::string itemName(std::size_t index) {
  return std::string(Spring::kTable) + "[" + std::to_string(index) + "]";
}

/// The first spring whose condition is nearly undefined at `positions`; empty when there is none.
std::string nearlyUndefinedSpring(const System& system, const Points& positions) {
  std::string name;
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    const auto& springs = system.springs<Spring>();
    for (std::size_t i = 0; i < springs.size() && name.empty(); ++i) {
      if (nearlyUndefined(springs[i], System::points(springs[i], positions))) {
        name = itemName<Spring>(i) + ", with antipodal vertices,";
      }
    }
  });
  return name;
}

/// Null for Newton's method.
std::unique_ptr<Descent> dynamicsOf(RelaxationMethod method, const System& system,
                                    OrientationGuard* guard) {
  switch (method) {
    case RelaxationMethod::newton:
      return nullptr;
    case RelaxationMethod::dynamics:
      return std::make_unique<DampedDynamics>(system, guard);
    case RelaxationMethod::fire:
      return std::make_unique<Fire>(system, guard);
  }
  return nullptr;
}

/// One relaxation under way.
class Relaxation {
 public:
  /// `newton` is to fit the system; `at_start`: whether it is at `positions` already.
  Relaxation(const System& system, const Points& positions, const RelaxationOptions& options,
             Newton& newton, bool at_start)
      : system_(system),
        options_(options),
        tolerance_(options.tolerance > 0 ? options.tolerance : defaultTolerance(system)),
        start_(positions),
        guard_(system),
        newton_(newton) {
    at_start = at_start && options.method == RelaxationMethod::newton;
    OrientationGuard* const guard = options.keep_orientation ? &guard_ : nullptr;
    newton_.keepOrientation(guard);
    dynamics_ = dynamicsOf(options.method, system, guard);
    descent_ = dynamics_ ? dynamics_.get() : &newton_;
    newton_.aimAt(tolerance_);
    if (!at_start) descent_->place(positions);
    first_torque_ = descent_->maxTorque();
    result_.energy_before = descent_->value();
    keep();
  }

  RelaxationResult run() {
    descendToMinimum();
    result_.positions = aligned(system_, start_, std::move(result_.positions));
    return std::move(result_);
  }

 private:
  enum class Outcome { within_tolerance, stuck, ended };

  void descendToMinimum() {
    constexpr unsigned kAttempts = 20;
    constexpr unsigned kStuckAttempts = 3;
    unsigned stuck = 0;
    for (unsigned attempt = 0; attempt < kAttempts; ++attempt) {
      const Outcome outcome = descend();
      if (outcome == Outcome::ended) return;
      if (outcome == Outcome::within_tolerance) {
        keep();
        if (!leaveSaddle()) {
          result_.converged = true;
          result_.message = "converged";
          return;
        }
        continue;
      }
      if (outcome == Outcome::stuck && (atRoundingFloor() || ++stuck > kStuckAttempts)) break;
      if (options_.keep_orientation) break;
      descent_->place(displaced(system_, descent_->positions(),
                                std::min(0.1, 1e-3 * std::pow(10, attempt)), attempt));
    }
    giveUp();
  }

  bool leaveSaddle() {
    if (dynamics_) newton_.place(dynamics_->positions());
    if (!newton_.leaveSaddle()) return false;
    if (dynamics_) dynamics_->place(newton_.positions());
    return true;
  }

  Outcome descend() {
    while (descent_->maxTorque() > tolerance_) {
      if (!goOn()) return Outcome::ended;
      const bool moved = descent_->iterate();
      ++result_.iterations;
      if (isBetter()) keep();
      if (!moved && descent_->maxTorque() > tolerance_) return Outcome::stuck;
    }
    return Outcome::within_tolerance;
  }

  /// Whether the torque is what rounding of the positions makes of the springs' stiffness.
  bool atRoundingFloor() const {
    constexpr double kRounding = 1e-11;
    return descent_->maxTorque() <
           kRounding * particleStiffness(system_, descent_->positions()).maxCoeff();
  }

  /// Lower in energy than what is kept or, where rounding hides that, in torque.
  bool isBetter() const {
    constexpr double kRounding = 1e-13;
    const double drop = result_.energy_after - descent_->value();
    if (std::abs(drop) > kRounding * result_.energy_after) return drop > 0;
    return descent_->maxTorque() < result_.max_torque;
  }

  void keep() {
    result_.positions = descent_->positions();
    result_.energy_after = descent_->value();
    result_.max_torque = descent_->maxTorque();
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
    if (options_.keep_orientation && guard_.tightest()) {
      reason = itemName<SolidAngleSpring>(*guard_.tightest()) + " would fold, which ends it";
    } else if (!spring.empty()) {
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
  const Points& start_;
  OrientationGuard guard_;
  Newton& newton_;
  std::unique_ptr<Descent> dynamics_;  // none for Newton's method
  Descent* descent_;
  double first_torque_;
  RelaxationResult result_;
};

}  // namespace

RelaxationMethod relaxationMethod(const std::string& name) {
  if (name.empty() || name == "newton") return RelaxationMethod::newton;
  if (name == "dynamics") return RelaxationMethod::dynamics;
  if (name == "fire") return RelaxationMethod::fire;
  throw std::invalid_argument("method is " + quoted(name) +
                              "; allowed: newton (the default), dynamics, fire");
}

double defaultTolerance(const System& system) { return 1e-9 * system.largestStiffness(); }

Relaxer::Relaxer() = default;
Relaxer::~Relaxer() = default;

RelaxationResult Relaxer::relax(const System& system, const Points& positions,
                                const RelaxationOptions& options) {
  requireInside(Range{0, kLargest, "0 (the default) to 1e30 [N m]"}, options.tolerance,
                "tolerance");
  requireInside(Range{0, kLargest, "0 (no limit) to 1e30 [s]"}, options.max_time, "max_time");
  // Only from the very place where the last one ended, so that results do not depend on what was
  // relaxed before from elsewhere.
  const bool goes_on = newton_ && newton_->fits(system) && positions == last_end_;
  if (goes_on) {
    newton_->goOn(system, positions);
  } else {
    newton_ = std::make_unique<Newton>(system, positions);
  }
  RelaxationResult result = Relaxation(system, positions, options, *newton_, goes_on).run();
  if (options.method == RelaxationMethod::newton) {
    last_end_ = result.positions;
  } else {
    newton_.reset();  // it was not on the way
  }
  return result;
}

RelaxationResult relax(const System& system, const Points& positions,
                       const RelaxationOptions& options) {
  return Relaxer().relax(system, positions, options);
}

}  // namespace spherical_springs::core
