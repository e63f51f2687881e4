#pragma once

#include <cstdint>

namespace spherical_springs {

/// Simulated time that has gone by in steps. A scene's own time also jumps: where a scene is
/// loaded, cleared or reset.
class SteppedTime {
 public:
  explicit SteppedTime(double time_step) : time_step_(time_step) {}

  /// Takes the number of steps since the scene's time was last 0, now and then.
  /// @return the time of the steps since the last call [s].
  double add(std::uint64_t steps) {
    // A scene that is loaded, cleared or reset counts its steps from 0 again.
    const std::uint64_t more = steps < steps_ ? steps : steps - steps_;
    steps_ = steps;
    const double time = time_step_ * static_cast<double>(more);
    total_ += time;
    return time;
  }

  /// The time of all steps so far [s].
  double total() const { return total_; }

 private:
  double time_step_;
  std::uint64_t steps_ = 0;
  double total_ = 0;
};

}  // namespace spherical_springs
