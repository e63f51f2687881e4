#include "workers.h"

namespace spherical_springs::core {
namespace {

/// Until `done()`: some microseconds at full attention, then leaving the processor to others, for
/// `most_turns` in all.
template <class Done>
bool waitFor(const Done& done, int most_turns) {
  constexpr int kSpins = 2000;
  for (int turn = 0; turn < most_turns; ++turn) {
    if (done()) return true;
    if (turn < kSpins) {
#if defined(__x86_64__) || defined(__i386__)
      __builtin_ia32_pause();
#endif
    } else {
      std::this_thread::yield();
    }
  }
  return false;
}

template <class Done>
void waitFor(const Done& done) {
  while (!waitFor(done, 1 << 20)) {
  }
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

void Workers::runShared(int threads, std::ptrdiff_t parts, const void* task) {
  while (static_cast<int>(threads_.size()) < threads - 1) {
    const int thread = static_cast<int>(threads_.size()) + 1;
    threads_.emplace_back([this, thread] { live(thread); });
  }
  task_ = task;
  parts_ = parts;
  sharing_ = threads;
  for (std::ptrdiff_t part = 0; part < parts; ++part) {
    taken_[part].store(false, std::memory_order_relaxed);
  }
  left_ = parts;
  open_ = true;
  ++loops_;
  if (asleep_ > 0) {
    { const std::lock_guard<std::mutex> lock(mutex_); }
    wake_.notify_all();
  }
  work(0);
  waitFor([this] { return left_ == 0; });
  open_ = false;
  waitFor([this] { return inside_ == 0; });
}

/// A thread's own share of the parts first, the same ones in every loop; then what others have not
/// begun.
void Workers::work(int thread) {
  const std::ptrdiff_t first = parts_ * thread / sharing_;
  for (std::ptrdiff_t i = 0; i < parts_ && left_ > 0; ++i) {
    const std::ptrdiff_t part = first + i < parts_ ? first + i : first + i - parts_;
    if (taken_[part].load(std::memory_order_relaxed) || taken_[part].exchange(true)) continue;
    call_(task_, part);
    --left_;
  }
}

void Workers::live(int thread) {
  std::uint64_t seen = 0;
  while (!ends_) {
    waitForLoop(seen);
    seen = loops_;
    ++inside_;
    if (open_ && thread < sharing_) work(thread);
    --inside_;
  }
}

void Workers::waitForLoop(std::uint64_t seen) {
  constexpr int kPatience = 4000;
  const auto called = [&] { return loops_ != seen || ends_; };
  if (waitFor(called, kPatience)) return;
  std::unique_lock<std::mutex> lock(mutex_);
  ++asleep_;
  wake_.wait(lock, called);
  --asleep_;
}

}  // namespace spherical_springs::core
