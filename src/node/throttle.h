#pragma once

#include <atomic>
#include <chrono>

namespace spherical_springs {

/// Lets something happen once in every so long. For many threads.
class Throttle {
 public:
  using Clock = std::chrono::steady_clock;

  explicit Throttle(Clock::duration period) : period_(period) {}

  /// Whether the time has come; if so, it does not come again before the period is over.
  bool isDue(Clock::time_point now = Clock::now()) noexcept {
    Clock::rep next = next_;
    const Clock::rep ticks = now.time_since_epoch().count();
    return ticks >= next && next_.compare_exchange_strong(next, ticks + period_.count());
  }

 private:
  const Clock::duration period_;
  std::atomic<Clock::rep> next_{Clock::duration::min().count()};
};

}  // namespace spherical_springs
