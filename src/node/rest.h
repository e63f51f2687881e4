#pragma once

#include <algorithm>
#include <chrono>

namespace spherical_springs {

/// Rests after work for four times as long as it took, so that work that comes again and again,
/// and takes long for large scenes, has a fifth of a processor at most.
class Rest {
 public:
  using Clock = std::chrono::steady_clock;

  bool isOver() const { return Clock::now() >= end_; }

  /// Work that lasts as long as this lives.
  class Work {
   public:
    explicit Work(Rest& rest) : rest_(rest) {}
    ~Work() {
      const auto end = Clock::now();
      rest_.end_ = end + std::max(shortest_, kRestAfterWork * (end - begin_));
    }
    Work(const Work&) = delete;
    Work& operator=(const Work&) = delete;

    /// Asks for a rest of `seconds` or more.
    void restAtLeast(double seconds) {
      shortest_ =
          std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
    }

   private:
    static constexpr int kRestAfterWork = 4;

    Rest& rest_;
    const Clock::time_point begin_ = Clock::now();
    Clock::duration shortest_{0};
  };

 private:
  Clock::time_point end_ = Clock::time_point::min();
};

}  // namespace spherical_springs
