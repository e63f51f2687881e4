#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <limits>
#include <thread>

#include "spherical_springs/maps/sphere_map.h"

namespace spherical_springs::mesh {

/// Thrown out of the middle of work on a map when its time is over and there is a map.
class TimeIsOver : public std::exception {};

/// Tells how long the search for a map goes on: until the time of its options is over or their
/// `go_on` has returned false, or memory has run out, but not before there is a map.
class MapClock {
 public:
  /// Starts now. `go_on` is called on this thread only. `options` must live longer.
  explicit MapClock(const MapOptions& options) : options_(options) {}

  /// Calls `go_on`, and returns whether there is time left. For the thread that made the clock.
  bool goOn();

  /// Calls `go_on` if the last call is some time ago. For any thread.
  /// @throw TimeIsOver, and what `go_on` throws.
  void check();

  /// Tells of the best map so far. For the thread that made the clock.
  void haveMap(double spread) { spread_ = std::min(spread, std::numeric_limits<double>::max()); }
  bool hasMap() const { return spread_ != kNoMap; }

  /// Ends the search, as memory has run out. For the thread that made the clock.
  void endWithoutMemory() { out_of_memory_ = ended_ = true; }
  bool outOfMemory() const { return out_of_memory_; }

  /// Whether to go on, which is so without a map whatever the time.
  bool ended() const { return ended_ && hasMap(); }

 private:
  using Clock = std::chrono::steady_clock;

  static constexpr double kNoMap = std::numeric_limits<double>::infinity();

  double elapsed() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }

  const MapOptions& options_;
  const std::thread::id thread_ = std::this_thread::get_id();
  const Clock::time_point begin_ = Clock::now();
  double last_call_ = 0;  // of `go_on` [s]
  bool out_of_memory_ = false;
  std::atomic<bool> ended_{false};
  std::atomic<double> spread_{kNoMap};  // of the best map so far
};

}  // namespace spherical_springs::mesh
