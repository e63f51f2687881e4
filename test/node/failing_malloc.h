// Memory that runs out when a test says so, in the thread that says so. To be included by one
// source of a program, as it replaces the C library's malloc.
#pragma once

#include <cerrno>
#include <cstddef>
#include <limits>

namespace spherical_springs::testing {

/// Allocations of this thread that succeed, and how many fail after them.
inline thread_local long succeeding = std::numeric_limits<long>::max(), failing = 0;

/// While one lives, `failing` allocations of this thread fail, after `succeeding` ones.
class ShortMemory {
 public:
  static constexpr long kAll = std::numeric_limits<long>::max();

  ShortMemory(long succeeding, long failing) {
    testing::failing = failing;
    testing::succeeding = succeeding;
  }
  ~ShortMemory() {
    testing::succeeding = kAll;
    testing::failing = 0;
  }
  ShortMemory(const ShortMemory&) = delete;
  ShortMemory& operator=(const ShortMemory&) = delete;
};

/// Counts one allocation. @return whether it fails.
inline bool fails() {
  if (succeeding > 0) {
    if (succeeding != ShortMemory::kAll) --succeeding;
    return false;
  }
  if (failing == 0) return false;
  if (failing != ShortMemory::kAll) --failing;
  return true;
}

}  // namespace spherical_springs::testing

extern "C" void* __libc_malloc(std::size_t size);
extern "C" void* __libc_memalign(std::size_t alignment, std::size_t size);

extern "C" void* malloc(std::size_t size) {
  if (!spherical_springs::testing::fails()) return __libc_malloc(size);
  errno = ENOMEM;
  return nullptr;
}

extern "C" void* aligned_alloc(std::size_t alignment, std::size_t size) {
  if (!spherical_springs::testing::fails()) return __libc_memalign(alignment, size);
  errno = ENOMEM;
  return nullptr;
}
