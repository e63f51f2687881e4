// Threads that share loops of some microseconds.
#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace spherical_springs::core {

/// Threads that wait for loops and share them. Between loops they spin for some microseconds, then
/// make way for others, then sleep. A caller never waits for a thread that has not begun: it does
/// that part itself, so a busy machine costs no more than the threads that it takes.
class Workers {
 public:
  Workers() = default;
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  /// The workers of the whole process.
  static Workers& shared();

  static constexpr std::ptrdiff_t kMostParts = 1024;

  /// Calls `task(part)` for parts from 0 to `parts` - 1, which are up to `kMostParts`, on up to
  /// `threads` threads. It takes fewer threads where some cannot be started, and the caller's alone
  /// where the workers are busy for another caller, or for one further up on the same stack.
  /// @throw what a task throws, the first one on any thread: parts that have begun are finished,
  /// others are left out. Nothing else, as a loop goes on without the memory for more threads.
  template <class Task>
  void run(int threads, std::ptrdiff_t parts, const Task& task) {
    if (threads <= 1 || parts <= 1 || busy_.test_and_set()) {
      for (std::ptrdiff_t part = 0; part < parts; ++part) task(part);
      return;
    }
    const Release release{busy_};
    runShared({[](const void* t, std::ptrdiff_t part) { (*static_cast<const Task*>(t))(part); },
               &task, parts, threads});
  }

 private:
  struct Release {
    std::atomic_flag& flag;
    ~Release() { flag.clear(); }
  };

  struct Loop {
    void (*call)(const void* task, std::ptrdiff_t part);
    const void* task;
    std::ptrdiff_t parts;
    int threads;
  };

  void start(int threads);
  void runShared(const Loop& loop);
  void publish(const Loop& loop);
  void work(int thread);
  void live(int thread);
  void waitForLoop(std::uint64_t seen);

  std::atomic_flag busy_ = ATOMIC_FLAG_INIT;  // whoever sets it owns what is not atomic
  std::vector<std::thread> threads_;

  // The loop under way. Workers read `loop_` only between entering and leaving (see `live`).
  Loop loop_{};
  std::array<std::atomic<bool>, kMostParts> taken_{};
  std::atomic<std::ptrdiff_t> left_{0};
  std::atomic<bool> failed_{false};
  std::exception_ptr
      fault_;  // written by the thread that sets `failed_`, read when no part is left
  std::atomic<bool> open_{false};
  std::atomic<int> inside_{0};
  std::atomic<std::uint64_t> loops_{0};

  std::atomic<bool> ends_{false};
  std::atomic<int> asleep_{0};
  std::mutex mutex_;
  std::condition_variable wake_;
};

}  // namespace spherical_springs::core
