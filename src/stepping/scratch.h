// Memory for work on one patch, taken before a loop over patches begins.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "stepping/layout.h"

namespace spherical_springs::core {

struct Scratch {
  std::vector<Row> sums;            ///< one row for each row of a patch
  std::vector<std::uint32_t> hard;  ///< indices of elements that kernels leave out
  std::vector<std::uint32_t> near;  ///< room for `MarkedElements`
};

/// As many scratches as threads share a loop over patches, each large enough for every patch, so
/// that nothing inside the loop allocates and a loop that has begun cannot fail.
class ScratchPool {
 public:
  /// `most_elements`: the largest number of elements of one sort in a patch, a multiple of kGroup.
  ScratchPool(const Layout& layout, std::uint32_t most_elements, int threads);

  /// A scratch that nobody else has during the lifetime of this object.
  class Lease {
   public:
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;
    ~Lease() { taken_.store(false, std::memory_order_release); }
    Scratch& operator*() const { return scratch_; }
    Scratch* operator->() const { return &scratch_; }

   private:
    friend class ScratchPool;
    Lease(Scratch& scratch, std::atomic<bool>& taken) : scratch_(scratch), taken_(taken) {}

    Scratch& scratch_;
    std::atomic<bool>& taken_;
  };

  /// Leases a scratch whose first `patch.row_count` sums are 0. At most as many threads as the pool
  /// was made for may hold one at a time.
  Lease lease(const Patch& patch);

 private:
  struct alignas(64) Slot {
    Scratch scratch;
    std::atomic<bool> taken{false};
  };

  std::vector<Slot> slots_;
};

/// The largest number of elements of one sort in a patch of `layout`.
std::uint32_t mostElements(const Layout& layout);

}  // namespace spherical_springs::core
