#pragma once

#include <algorithm>
#include <cmath>

namespace spherical_springs {

/// Counts the simulated time that is due as the clock goes on.
class StepClock {
 public:
  explicit StepClock(double real_time_factor) : real_time_factor_(real_time_factor) {}

  /// Goes on with other numbers. What is left of a step stays, but for whole steps that it makes
  /// now, which would come all at once.
  void change(double time_step, double real_time_factor) {
    keep(owed_, time_step);
    real_time_factor_ = real_time_factor;
  }

  /// Returns the simulated time [s] that is due after another `elapsed` [s] of the clock, with what
  /// was left. A clock that goes back counts as standing still, and a jump ahead as `kLongest`, so
  /// that work never piles up.
  double due(double elapsed) const {
    constexpr double kLongest = 1;  // [s]
    return owed_ + std::clamp(elapsed, 0., kLongest) * real_time_factor_;
  }

  /// Keeps what is left [s] of a step [s] for the next time, without the whole steps that were not
  /// done.
  void keep(double left, double time_step) { owed_ = std::fmod(left, time_step); }

 private:
  double real_time_factor_;
  double owed_ = 0;  // [s]
};

}  // namespace spherical_springs
