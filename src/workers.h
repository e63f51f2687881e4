// Threads that share loops of some microseconds.
#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <thread>
#include <vector>

namespace spherical_springs::core {

/// Threads for the whole process. Between loops they spin for some microseconds, then make way for
/// others, then sleep. A caller never waits for one that has not begun: it does that part itself,
/// so a busy machine costs no more than the threads that it takes.
class Workers {
 public:
  static Workers& shared();
  ~Workers();

  /// Calls `task(part)` for parts from 0 to `parts` - 1, which are up to `kMostParts`, on up to
  /// `threads` threads; alone where the workers are busy for another caller.
  template <class Task>
  void run(int threads, std::ptrdiff_t parts, const Task& task) {
    if (threads <= 1 || parts <= 1 || busy_.test_and_set()) {
      for (std::ptrdiff_t part = 0; part < parts; ++part) task(part);
      return;
    }
    call_ = [](const void* t, std::ptrdiff_t part) { (*static_cast<const Task*>(t))(part); };
    runShared(threads, parts, &task);
    busy_.clear();
  }

  static constexpr std::ptrdiff_t kMostParts = 1024;

 private:
  Workers() = default;
  void runShared(int threads, std::ptrdiff_t parts, const void* task);
  void work(int thread);
  void live(int thread);
  void waitForLoop(std::uint64_t seen);

  std::atomic_flag busy_ = ATOMIC_FLAG_INIT;
  std::vector<std::thread> threads_;

  // Of the loop under way; only read by workers that have entered while it is open.
  void (*call_)(const void* task, std::ptrdiff_t part) = nullptr;
  const void* task_ = nullptr;
  std::ptrdiff_t parts_ = 0;
  int sharing_ = 0;
  std::array<std::atomic<bool>, kMostParts> taken_{};
  std::atomic<std::ptrdiff_t> left_{0};
  std::atomic<bool> open_{false};
  std::atomic<int> inside_{0};
  std::atomic<std::uint64_t> loops_{0};

  std::atomic<bool> ends_{false};
  std::atomic<int> asleep_{0};
  std::mutex mutex_;
  std::condition_variable wake_;
};

}  // namespace spherical_springs::core
