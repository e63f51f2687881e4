#include "base/workers.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace spherical_springs::core {
namespace {

// Turns of waiting: 50 us of spinning (Zen 4), then yields, each of which takes 0.4 us where no
// other thread wants the processor.
constexpr std::ptrdiff_t kSpins = 2000, kYields = 2000;
// A worker waits for so many turns between loops before it sleeps. Waking it takes longer than most
// loops, and relaxations have gaps of some 100 us.
constexpr std::ptrdiff_t kPatience = kSpins + 400;

/// Lets a moment go by for whoever waits for something that other threads do within microseconds,
/// if they have a processor. After many turns they probably have none, and this thread gives up its
/// own: to threads of the same priority, in the end to any.
void pause(std::ptrdiff_t turn) {
  if (turn < kSpins) {
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#endif
  } else if (turn < kSpins + kYields) {
    std::this_thread::yield();
  } else {
    std::this_thread::sleep_for(std::chrono::microseconds(50));
  }
}

template <class Done>
void waitFor(const Done& done) {
  for (std::ptrdiff_t turn = 0; !done(); ++turn) pause(turn);
}

}  // namespace

Workers& Workers::shared() {
  static Workers workers;
  return workers;
}

Workers::~Workers() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ends_ = true;
  }
  wake_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

/// Starts what is missing of `threads` threads, the caller's among them, as far as memory and the
/// limits of the system allow; the next loop tries again.
void Workers::start(int threads) {
  try {
    while (static_cast<int>(threads_.size()) + 1 < threads) {
      const int thread = static_cast<int>(threads_.size()) + 1;
      threads_.emplace_back([this, thread] { live(thread); });
    }
  } catch (const std::exception&) {
  }
}

void Workers::runShared(const Loop& loop) {
  start(loop.threads);
  publish(loop);
  work(0);
  waitFor([this] { return left_ == 0; });
  open_ = false;
  waitFor([this] { return inside_ == 0; });
  if (failed_) std::rethrow_exception(std::exchange(fault_, nullptr));
}

void Workers::publish(const Loop& loop) {
  loop_ = loop;
  loop_.threads = std::min(loop.threads, static_cast<int>(threads_.size()) + 1);
  for (std::ptrdiff_t part = 0; part < loop.parts; ++part) {
    taken_[part].store(false, std::memory_order_relaxed);
  }
  left_ = loop.parts;
  failed_ = false;
  open_ = true;
  ++loops_;
  if (asleep_ > 0) {
    { const std::lock_guard<std::mutex> lock(mutex_); }
    wake_.notify_all();
  }
}

/// Does a thread's own share of the parts first, which is the same in every loop, for the caches;
/// then parts that others have not begun. After an exception parts are only counted.
void Workers::work(int thread) {
  const std::ptrdiff_t first = loop_.parts * thread / loop_.threads;
  for (std::ptrdiff_t i = 0; i < loop_.parts && left_ > 0; ++i) {
    const std::ptrdiff_t part = first + i < loop_.parts ? first + i : first + i - loop_.parts;
    if (taken_[part].load(std::memory_order_relaxed) || taken_[part].exchange(true)) continue;
    try {
      if (!failed_) loop_.call(loop_.task, part);
    } catch (...) {
      if (!failed_.exchange(true)) fault_ = std::current_exception();
    }
    --left_;
  }
}

/// A worker may be late, and come when the caller is about to return, whose `task` ends with that.
/// So a worker enters (`++inside_`) before it looks whether the loop is open, and the caller closes
/// the loop before it looks whether anybody is inside. All four are sequentially consistent, in one
/// order for all threads: if the worker has seen the loop open, it had entered before the caller
/// closed it, so the caller sees it inside and waits until it has left; if the caller has seen
/// nobody inside, a worker that enters later sees the loop closed and leaves at once, or open again
/// for a later loop, which was published whole before it was opened.
void Workers::live(int thread) {
  std::uint64_t seen = 0;
  while (!ends_) {
    waitForLoop(seen);
    seen = loops_;
    ++inside_;
    if (open_ && thread < loop_.threads) work(thread);
    --inside_;
  }
}

/// Whoever falls asleep counts itself (`++asleep_`) before it looks for a new loop a last time, and
/// a caller counts the loop (`++loops_`) before it looks for sleepers: one of them sees the other.
void Workers::waitForLoop(std::uint64_t seen) {
  const auto called = [&] { return loops_ != seen || ends_; };
  for (std::ptrdiff_t turn = 0; turn < kPatience; ++turn) {
    if (called()) return;
    pause(turn);
  }
  std::unique_lock<std::mutex> lock(mutex_);
  ++asleep_;
  wake_.wait(lock, called);
  --asleep_;
}

}  // namespace spherical_springs::core
