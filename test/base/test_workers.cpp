// Loops over threads: complete, shared by as many threads as asked for, and unharmed by bodies that
// throw and by threads that do not start. scripts/thread_sanitizer runs these tests too.
#include <gtest/gtest.h>
#include <pthread.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <memory>
#include <new>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include "base/parallel.h"
#include "base/workers.h"

namespace {

thread_local bool memory_is_short = false;

}  // namespace

// The standard one, but that it can be told to fail on a thread.
[[gnu::noinline]] void* operator new(std::size_t size) {
  if (memory_is_short) throw std::bad_alloc();
  if (void* const memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return memory_is_short ? nullptr : std::malloc(size);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace spherical_springs::core {
namespace {

using Clock = std::chrono::steady_clock;

/// Waits for a condition, which holds soon unless the code under test is at fault.
template <class Condition>
bool comesTrue(const Condition& condition) {
  const auto deadline = Clock::now() + std::chrono::seconds(20);
  while (!condition()) {
    if (Clock::now() > deadline) return false;
    std::this_thread::yield();
  }
  return true;
}

/// How many threads take part in a loop of as many parts, none of which ends before all have begun
/// or it is clear that they will not.
std::size_t threadsOfALoop(Workers& workers, int threads, int expected) {
  std::atomic<int> begun{0};
  std::vector<std::thread::id> ids(threads);
  workers.run(threads, threads, [&](std::ptrdiff_t part) {
    ids[part] = std::this_thread::get_id();
    ++begun;
    comesTrue([&] { return begun >= expected; });
  });
  return std::set<std::thread::id>(ids.begin(), ids.end()).size();
}

std::size_t threadsOfALoop(Workers& workers, int threads) {
  return threadsOfALoop(workers, threads, threads);
}

/// While it lives, the stack that a new thread asks for is larger than any address space.
class NoThreadStarts {
 public:
  NoThreadStarts() {
    pthread_getattr_default_np(&before_);
    pthread_attr_t enormous;
    pthread_attr_init(&enormous);
    pthread_attr_setstacksize(&enormous, std::size_t(1) << 60);
    pthread_setattr_default_np(&enormous);
    pthread_attr_destroy(&enormous);
  }
  ~NoThreadStarts() {
    pthread_setattr_default_np(&before_);
    pthread_attr_destroy(&before_);
  }

 private:
  pthread_attr_t before_;
};

class ShortMemory {
 public:
  ShortMemory() { memory_is_short = true; }
  ~ShortMemory() { memory_is_short = false; }
};

TEST(Workers, DoEveryPartOnce) {
  for (const std::ptrdiff_t count : {0, 1, 2, 5, 1000, 5000}) {
    for (const int threads : {1, 2, 3, 8}) {
      std::vector<int> done(count, 0);
      forOnThreads(count, threads, [&](std::ptrdiff_t i) { ++done[i]; });
      EXPECT_EQ(done, std::vector<int>(count, 1)) << count << " on " << threads << " threads";
    }
  }
}

TEST(Workers, AreAsManyAsAskedFor) {
  Workers workers;
  for (const int threads : {2, 8, 3, 1, 40}) EXPECT_EQ(threadsOfALoop(workers, threads), threads);
}

TEST(Workers, ServeSeveralCallersAtOnce) {
  constexpr int kLoops = 2000;
  std::vector<std::thread> callers;
  for (int caller = 0; caller < 4; ++caller) {
    callers.emplace_back([caller] {
      std::vector<std::ptrdiff_t> places(500);
      for (int loop = 0; loop < kLoops; ++loop) {
        const std::ptrdiff_t offset = loop + caller;
        forOnThreads(places.size(), 2 + loop % 3,
                     [&](std::ptrdiff_t i) { places[i] = i + offset; });
        std::ptrdiff_t sum = 0;
        for (const std::ptrdiff_t place : places) sum += place - offset;
        ASSERT_EQ(sum, 499 * 500 / 2);
        // Long enough for the pool to fall asleep.
        if (loop % 100 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(5));
      }
    });
  }
  for (std::thread& caller : callers) caller.join();
}

TEST(Workers, LeaveACallerToItselfWhileTheyAreBusyForAnother) {
  Workers workers;
  std::atomic<bool> busy{false}, ends{false};
  std::thread other([&] {
    workers.run(2, 2, [&](std::ptrdiff_t) {
      busy = true;
      comesTrue([&] { return ends.load(); });
    });
  });
  ASSERT_TRUE(comesTrue([&] { return busy.load(); }));
  EXPECT_EQ(threadsOfALoop(workers, 2, 0), 1);
  ends = true;
  other.join();
  EXPECT_EQ(threadsOfALoop(workers, 2), 2);
}

TEST(Workers, DoLoopsWithinLoops) {
  Workers workers;
  constexpr std::ptrdiff_t kOuter = 6, kInner = 50;
  std::vector<int> done(kOuter * kInner, 0);
  workers.run(3, kOuter, [&](std::ptrdiff_t outer) {
    workers.run(3, kInner, [&](std::ptrdiff_t inner) { ++done[outer * kInner + inner]; });
  });
  EXPECT_EQ(done, std::vector<int>(kOuter * kInner, 1));
  EXPECT_EQ(threadsOfALoop(workers, 3), 3);
}

// The caller's thread, one of the pool, or all at once.
enum class Thrower { caller, other, all };

class ThrowingBodies : public ::testing::TestWithParam<Thrower> {
 protected:
  bool throwsHere() const {
    const bool is_caller = std::this_thread::get_id() == caller_;
    return GetParam() == Thrower::all || (GetParam() == Thrower::caller) == is_caller;
  }

  Workers workers_;

 private:
  std::thread::id caller_ = std::this_thread::get_id();
};

TEST_P(ThrowingBodies, GiveTheirExceptionToTheCallerWhenNoOtherBodyIsUnderWay) {
  constexpr int kThreads = 3;
  for (int loop = 0; loop < 50; ++loop) {
    std::atomic<int> begun{0}, under_way{0};
    const auto body = [&](std::ptrdiff_t) {
      ++under_way;
      ++begun;
      comesTrue([&] { return begun >= kThreads; });
      if (!throwsHere()) std::this_thread::sleep_for(std::chrono::microseconds(100));
      --under_way;
      if (throwsHere()) throw std::runtime_error("thrown in a body");
    };
    try {
      workers_.run(kThreads, 4 * kThreads, body);
      FAIL() << "nothing thrown";
    } catch (const std::runtime_error& fault) {
      EXPECT_STREQ(fault.what(), "thrown in a body");
    }
    ASSERT_EQ(under_way, 0);
    // The next loop is complete, and shared.
    ASSERT_EQ(threadsOfALoop(workers_, kThreads), kThreads);
  }
}

TEST_P(ThrowingBodies, RunOutOfMemory) {
  EXPECT_THROW(workers_.run(2, 2,
                            [&, begun = std::make_shared<std::atomic<int>>(0)](std::ptrdiff_t) {
                              ++*begun;
                              comesTrue([&] { return *begun >= 2; });
                              if (!throwsHere()) return;
                              const ShortMemory short_memory;
                              ::operator delete(::operator new(800));
                            }),
               std::bad_alloc);
  EXPECT_EQ(threadsOfALoop(workers_, 2), 2);
}

INSTANTIATE_TEST_SUITE_P(Workers, ThrowingBodies,
                         ::testing::Values(Thrower::caller, Thrower::other, Thrower::all));

TEST(Workers, GiveOnWhatIsThrownInLoopsWithinLoops) {
  Workers workers;
  for (const std::ptrdiff_t thrower : {0, 9, 59}) {
    const auto outer = [&](std::ptrdiff_t i) {
      workers.run(3, 10, [&](std::ptrdiff_t j) {
        if (10 * i + j == thrower) throw std::out_of_range("inner");
      });
    };
    EXPECT_THROW(workers.run(3, 6, outer), std::out_of_range);
    EXPECT_EQ(threadsOfALoop(workers, 3), 3);
  }
}

TEST(Workers, GiveEachCallerItsOwnException) {
  std::vector<std::thread> callers;
  for (int caller = 0; caller < 4; ++caller) {
    callers.emplace_back([caller] {
      for (int loop = 0; loop < 1000; ++loop) {
        int caught = -1;
        try {
          forOnThreads(100, 3, [&](std::ptrdiff_t i) {
            if (i % 30 == loop % 30) throw caller;
          });
        } catch (const int thrown) {
          caught = thrown;
        }
        ASSERT_EQ(caught, caller);
      }
    });
  }
  for (std::thread& caller : callers) caller.join();
}

TEST(Workers, DoWithoutThreadsThatCannotBeStartedAndTryAgain) {
  Workers workers;
  {
    const NoThreadStarts none;
    EXPECT_EQ(threadsOfALoop(workers, 3, 1), 1);
    EXPECT_EQ(threadsOfALoop(workers, 2, 1), 1);
  }
  EXPECT_EQ(threadsOfALoop(workers, 2), 2);
  {
    const NoThreadStarts no_third;
    EXPECT_EQ(threadsOfALoop(workers, 3, 2), 2);
  }
  EXPECT_EQ(threadsOfALoop(workers, 3), 3);
}

TEST(Workers, DoALoopWithoutMemoryForItsThreads) {
  Workers workers;
  std::vector<int> done(1000, 0);
  {
    const ShortMemory short_memory;
    workers.run(4, 1000, [&](std::ptrdiff_t i) { ++done[i]; });
  }
  EXPECT_EQ(done, std::vector<int>(1000, 1));
  EXPECT_EQ(threadsOfALoop(workers, 4), 4);
}

TEST(Workers, FoldToTheSameBitsOnAnyNumberOfThreads) {
  const auto sum = [](int threads) {
    return parallelSum(100'000, threads, [](std::ptrdiff_t i) { return 1. / (1 + i); });
  };
  for (const int threads : {2, 3, 8, 40}) EXPECT_EQ(sum(threads), sum(1)) << threads;
}

}  // namespace
}  // namespace spherical_springs::core
