#pragma once

namespace spherical_springs {

/// Tells whether simulated time falls behind the clock, judged over a second or more of running.
class RealTimeMonitor {
 public:
  RealTimeMonitor(double real_time_factor, double time_step)
      : real_time_factor_(real_time_factor), time_step_(time_step) {}

  /// Takes what holds from now on. Where it is something else, judging begins anew.
  void expect(double real_time_factor, double time_step) {
    running_ = running_ && real_time_factor == real_time_factor_ && time_step == time_step_;
    real_time_factor_ = real_time_factor;
    time_step_ = time_step;
  }

  /// Takes the clock [s] and the simulated time [s]; to be called now and then, and when running
  /// begins or ends.
  /// @return whether simulated time falls behind.
  bool behind(bool running, double clock, double simulated) {
    constexpr double kLongEnough = 0.95;  // [s]
    constexpr double kEnough = 0.9;       // of what is due
    if (!running || !running_ || clock < clock_ || simulated < simulated_) {
      behind_ = false;
    } else if (clock - clock_ < kLongEnough) {
      return behind_;
    } else {
      const double due = real_time_factor_ * (clock - clock_);
      behind_ = simulated - simulated_ < kEnough * due - time_step_;
    }
    running_ = running;
    clock_ = clock;
    simulated_ = simulated;
    return behind_;
  }

 private:
  double real_time_factor_, time_step_;
  bool running_ = false, behind_ = false;
  double clock_ = 0, simulated_ = 0;
};

}  // namespace spherical_springs
