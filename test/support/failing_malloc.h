// Memory that runs out when a test says so. To be included by one source of a program, as it
// replaces the C library's malloc.
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>
#include <limits>
#include <new>
#include <string>
#include <system_error>

namespace spherical_springs::core::testing {

// Counted down by allocations; the one that finds 0 fails. Below zero: no bound.
inline thread_local long allocations_left = -1;          // of this thread
inline std::atomic<long> allocations_left_anywhere{-1};  // of all threads
inline std::atomic<bool> later_ones_fail_too{false};

inline thread_local bool is_victim = false;
inline std::atomic<bool> victims_fail{false};

/// Counts one allocation. @return whether it fails.
inline bool nextFails() {
  if (is_victim && victims_fail) return true;
  if (allocations_left >= 0 && allocations_left-- == 0) return true;
  long left = allocations_left_anywhere;
  while (left >= 0) {
    if (left == 0 && later_ones_fail_too) return true;
    if (allocations_left_anywhere.compare_exchange_weak(left, left - 1)) return left == 0;
  }
  return false;
}

/// Lets allocations of all threads fail.
class ShortOfMemory : public ::testing::Test {
 protected:
  ~ShortOfMemory() override { allocations_left_anywhere = -1; }

  /// Lets the allocation at `number` of a call fail, on whatever thread it is, and all later ones
  /// where `for_good`.
  /// @return whether the call threw for it.
  template <class Call>
  static bool fails(long number, bool for_good, const Call& call) {
    later_ones_fail_too = for_good;
    allocations_left_anywhere = number;
    bool failed = false;
    try {
      call();
    } catch (const std::bad_alloc&) {
      failed = true;
    } catch (const std::system_error&) {  // of a thread that could not be started
      failed = true;
    }
    allocations_left_anywhere = -1;
    return failed;
  }

  /// @return how many allocations a call makes.
  template <class Call>
  static long allocationsOf(const Call& call) {
    constexpr long kMany = std::numeric_limits<long>::max();
    allocations_left_anywhere = kMany;
    call();
    return kMany - allocations_left_anywhere.exchange(-1);
  }

  /// Calls once for each allocation that may fail, later ones at growing distances, with `check`
  /// after each failure, until a call succeeds.
  /// @return how often it failed.
  template <class Call, class Check>
  static int failAgainAndAgain(bool for_good, const Call& call, const Check& check) {
    int failures = 0;
    for (long number = 0; fails(number, for_good, call); number += 1 + number / 16) {
      check("at allocation " + std::to_string(number));
      ++failures;
    }
    return failures;
  }
};

}  // namespace spherical_springs::core::testing

extern "C" void* __libc_malloc(std::size_t size);
extern "C" void* __libc_memalign(std::size_t alignment, std::size_t size);

// The C library's own, but for those that fail when they are told to.
extern "C" void* malloc(std::size_t size) {
  return spherical_springs::core::testing::nextFails() ? nullptr : __libc_malloc(size);
}
extern "C" void* aligned_alloc(std::size_t alignment, std::size_t size) {
  return spherical_springs::core::testing::nextFails() ? nullptr : __libc_memalign(alignment, size);
}
