#include "relaxation/minimum_search.h"

#include <algorithm>
#include <cmath>

#include "relaxation/damped_dynamics.h"
#include "relaxation/fire.h"
#include "relaxation/new_starts.h"
#include "relaxation/turn_back.h"
#include "spherical_springs/range.h"

namespace spherical_springs::core {
namespace {

/// Null for Newton's method.
std::unique_ptr<Descent> dynamicsOf(RelaxationMethod method, const System& system,
                                    OrientationGuard* guard, const TorqueLimit& limit) {
  switch (method) {
    case RelaxationMethod::newton:
    case RelaxationMethod::global:
      return nullptr;
    case RelaxationMethod::dynamics:
      return std::make_unique<DampedDynamics>(system, guard, limit);
    case RelaxationMethod::fire:
      return std::make_unique<Fire>(system, guard, limit);
  }
  return nullptr;
}

double shareOf(unsigned attempt) { return std::min(0.1, 1e-3 * std::pow(10, attempt)); }

/// Whether the torque on each particle is what rounding of the positions makes of the stiffness
/// that it feels.
bool atRoundingFloor(const System& system, const Points& positions) {
  constexpr double kRounding = 1e-11;
  const Eigen::VectorXd stiffness = feltStiffness(system, positions);
  System::Workspace workspace;
  system.evaluate(positions, workspace);
  for (Eigen::Index i = 0; i < positions.cols(); ++i) {
    if (system.pinned(i)) continue;
    if (workspace.torques.col(i).norm() > kRounding * stiffness[i]) return false;
  }
  return true;
}

}  // namespace

MinimumSearch::MinimumSearch(const System& system, const Points& positions,
                             const RelaxationOptions& options, Newton& newton, bool at_start)
    : system_(system),
      options_(options),
      limit_(system, options.tolerance),
      start_(positions),
      guard_(system),
      newton_(newton) {
  OrientationGuard* const guard = options.keep_orientation ? &guard_ : nullptr;
  newton_.keepOrientation(guard);
  newton_.aimAt(&limit_);
  if (!at_start) newton_.place(positions);
  calm_ = newton_.calm();
  dynamics_ = dynamicsOf(options.method, system, guard, limit_);
  if (dynamics_) dynamics_->place(positions);
  descent_ = dynamics_ ? dynamics_.get() : &newton_;
  first_excess_ = descent_->excess();
  result_.energy_before = descent_->value();
  keep();
}

MinimumSearch::~MinimumSearch() {
  newton_.aimAt(nullptr);
  newton_.keepOrientation(nullptr);
}

RelaxationResult MinimumSearch::run() {
  descendToMinimum();
  turnBack(system_, start_, calm_, result_);
  return std::move(result_);
}

void MinimumSearch::descendToMinimum() {
  constexpr unsigned kAttempts = 20;
  constexpr unsigned kStuckAttempts = 3;
  unsigned stuck = 0;
  for (unsigned attempt = 0; attempt < kAttempts; ++attempt) {
    const Outcome outcome = descend();
    if (flat_ && !isBelowFlat()) {
      if (outcome != Outcome::ended && leaveFlat()) continue;
      goBackToFlat();
      if (outcome != Outcome::ended) converge();
      return;
    }
    flat_.reset();
    if (outcome == Outcome::ended) return;
    const bool at_minimum = outcome == Outcome::within_limit && mayBeTheEnd();
    if (at_minimum) keep();
    if (!undefinedSpring(system_, result_.positions).empty()) {
      if (leaveUndefined(attempt)) continue;
      break;
    }
    if (at_minimum) {
      if (leaveSaddle()) continue;
      flat_ = result_.positions;
      if (leaveFlat()) continue;
      converge();
      return;
    }
    if (outcome == Outcome::stuck) {
      if (leaveFlat()) continue;
      if (atRoundingFloor(system_, descent_->positions()) || ++stuck > kStuckAttempts) break;
      if (stuck == 1) {  // without what it has learnt on the way a descent may get further
        descent_->place(descent_->positions());
        continue;
      }
    }
    if (options_.keep_orientation) break;
    descent_->place(displaced(system_, descent_->positions(), shareOf(attempt), attempt));
  }
  giveUp();
}

bool MinimumSearch::leaveSaddle() {
  if (dynamics_) newton_.place(dynamics_->positions());
  if (!newton_.leaveSaddle()) return false;
  if (dynamics_) dynamics_->place(newton_.positions());
  return true;
}

/// Starts again beside a place where the condition of a spring is undefined, and with it the
/// energy: it need be no minimum, though nothing pulls there.
bool MinimumSearch::leaveUndefined(unsigned attempt) {
  constexpr unsigned kAttempts = 4;
  if (options_.keep_orientation || attempt >= kAttempts) return false;
  const Points beside = besideUndefined(system_, result_.positions, shareOf(attempt), attempt);
  if (!undefinedSpring(system_, beside).empty()) return false;
  descent_->place(beside);
  return true;
}

void MinimumSearch::converge() {
  result_.converged = true;
  result_.message = "converged";
}

/// Starts again, a few times in all, beside springs that are flat (`isFlat`), as their energy may
/// fall though no torque and no curvature shows it. Where the way leads no lower than `flat_`,
/// that is a minimum.
bool MinimumSearch::leaveFlat() {
  constexpr unsigned kAttempts = 2;
  constexpr double kDistance = 0.05;  // [rad]
  if (options_.keep_orientation || flat_attempts_ >= kAttempts) return false;
  const Points& from = flat_ ? *flat_ : result_.positions;
  const Points beside = besideFlat(system_, from, kDistance * (flat_attempts_ + 1), flat_attempts_);
  if (beside == from) return false;
  ++flat_attempts_;
  descent_->place(beside);
  return true;
}

/// Whether the descent has come lower than it was at `flat_`, by more than rounding.
bool MinimumSearch::isBelowFlat() {
  const Points reached = descent_->positions();
  newton_.place(*flat_);
  const double at_flat = newton_.scaledValue();
  newton_.place(reached);
  return newton_.scaledValue() < (1 - kEnergyRounding) * at_flat;
}

void MinimumSearch::goBackToFlat() {
  descent_->place(*flat_);
  keep();
}

// A minimum is approached to below the limit, so that it is within it however rounding, and the
// turn of the whole at the end, change the torque.
MinimumSearch::Outcome MinimumSearch::descend() {
  constexpr double kEnough = 0.9;
  if (descent_->excess() <= 1) return Outcome::within_limit;
  while (descent_->excess() > kEnough) {
    if (!goOn()) return Outcome::ended;
    const bool moved = descent_->iterate();
    ++result_.iterations;
    if (isBetter()) keep();
    if (!moved) return descent_->excess() <= 1 ? Outcome::within_limit : Outcome::stuck;
  }
  return Outcome::within_limit;
}

/// Whether the descent is no higher than what is kept, but for rounding. The energy where a
/// spring is undefined is a convention: an end may be above such a place on the way, but above
/// the start only where that is one too.
bool MinimumSearch::mayBeTheEnd() const {
  const auto isAtMost = [&](double energy) {
    return descent_->value() <= (1 + kEnergyRounding) * energy;
  };
  if (isAtMost(result_.energy_after)) return true;
  if (undefinedSpring(system_, result_.positions).empty()) return false;
  if (!undefinedSpring(system_, descent_->positions()).empty()) return false;
  return isAtMost(result_.energy_before) || !undefinedSpring(system_, start_).empty();
}

/// Lower in energy than what is kept or, where rounding hides that, in torque.
bool MinimumSearch::isBetter() const {
  const double drop = result_.energy_after - descent_->value();
  if (std::abs(drop) > kEnergyRounding * result_.energy_after) return drop > 0;
  return descent_->excess() < excess_;
}

void MinimumSearch::keep() {
  result_.positions = descent_->positions();
  result_.energy_after = descent_->value();
  result_.max_torque = descent_->maxTorque();
  excess_ = descent_->excess();
}

bool MinimumSearch::goOn() {
  const double elapsed = std::chrono::duration<double>(Clock::now() - begin_).count();
  if (options_.max_time > 0 && elapsed >= options_.max_time) {
    result_.message = "max_time is over; " + torqueLeft();
    return false;
  }
  if (options_.go_on({result_, fraction()})) return true;
  result_.message = "cancelled; largest torque " + toText(result_.max_torque) + " N m";
  return false;
}

/// How much of the way to the limit is done, by the logarithm of the torque.
double MinimumSearch::fraction() const {
  const double way = std::log(first_excess_);
  const double gone = std::log(first_excess_ / std::max(excess_, 1.));
  return way > 0 && std::isfinite(way) ? std::clamp(gone / way, 0., 1.) : 0;
}

void MinimumSearch::giveUp() {
  // Rounding of the positions rules the torque of a stiff spring well before kUndefined.
  constexpr double kFloor = 1e-4;
  const bool at_floor = atRoundingFloor(system_, result_.positions);
  const std::string undefined =
      undefinedSpring(system_, result_.positions, at_floor ? kFloor : kUndefined);
  std::string reason = descent_->whyStuck();
  if (options_.keep_orientation && guard_.tightest()) {
    reason = nameOf<SolidAngleSpring>(system_, *guard_.tightest()) + " would fold";
  } else if (!undefined.empty()) {
    reason = undefined + " has antipodal vertices, where its area is undefined";
  } else if (excess_ <= 1) {
    reason = "the torque is within the tolerance, but not at a minimum of the energy";
  } else if (at_floor) {
    reason = "rounding lets no step lower the energy further";
  }
  result_.message = "stopped: " + reason + "; " + torqueLeft();
}

std::string MinimumSearch::torqueLeft() const {
  const std::string largest = "largest torque " + toText(result_.max_torque) + " N m";
  return largest + excessInWords(system_, result_.positions, limit_);
}

}  // namespace spherical_springs::core
