#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace spherical_springs {

/// Counts the steps that are due as time goes by.
class StepClock {
 public:
  StepClock(double time_step, double real_time_factor)
      : time_step_(time_step), real_time_factor_(real_time_factor) {}

  double timeStep() const { return time_step_; }

  /// Goes on with other numbers. What is left of a step stays the same simulated time, but for
  /// whole steps that it makes now, which would come all at once.
  void change(double time_step, double real_time_factor) {
    owed_ *= time_step_ / time_step;
    owed_ -= std::floor(owed_);
    time_step_ = time_step;
    real_time_factor_ = real_time_factor;
  }

  /// Steps due after another `elapsed` [s] of the clock. A clock that goes back counts as standing
  /// still, and a jump ahead as `kLongest`, so that work never piles up; what is left of a step is
  /// kept for the next time.
  std::uint64_t due(double elapsed) {
    constexpr double kLongest = 1;  // [s]
    constexpr double kMostSteps = 1e15;
    owed_ += std::clamp(elapsed, 0., kLongest) * (real_time_factor_ / time_step_);
    const double whole = std::min(std::floor(owed_), kMostSteps);
    owed_ -= std::floor(owed_);
    return static_cast<std::uint64_t>(whole);
  }

 private:
  double time_step_, real_time_factor_;
  double owed_ = 0;
};

}  // namespace spherical_springs
