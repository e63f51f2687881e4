#include "stepping/scratch.h"

#include <algorithm>
#include <thread>

namespace spherical_springs::core {
namespace {

/// Numbers threads in the order of their first call, so that each mostly gets the scratch that is
/// in its cache.
std::size_t threadNumber() {
  static std::atomic<std::size_t> next{0};
  thread_local const std::size_t number = next++;
  return number;
}

}  // namespace

ScratchPool::ScratchPool(const Layout& layout, std::uint32_t most_elements, int threads)
    : slots_(std::max(threads, 1)) {
  for (Slot& slot : slots_) {
    slot.scratch.sums.resize(layout.largestPatch());
    slot.scratch.hard.resize(most_elements);
    slot.scratch.near.resize(most_elements);
  }
}

ScratchPool::Lease ScratchPool::lease(const Patch& patch) {
  for (std::size_t i = threadNumber();; ++i) {
    Slot& slot = slots_[i % slots_.size()];
    if (slot.taken.exchange(true, std::memory_order_acquire)) {
      std::this_thread::yield();
      continue;
    }
    std::fill_n(slot.scratch.sums.begin(), patch.row_count, Row{});
    return {slot.scratch, slot.taken};
  }
}

std::uint32_t mostElements(const Layout& layout) {
  std::uint32_t most = 0;
  for (const Patch& patch : layout.patches()) {
    for (const GroupRange& range : patch.groups) most = std::max(most, range.end - range.begin);
  }
  return most * static_cast<std::uint32_t>(kGroup);
}

}  // namespace spherical_springs::core
