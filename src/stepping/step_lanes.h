// The forces of step_kernels.h, for whatever level of instruction set a file that includes this is
// compiled for. The formulas are those of src/springs.
#pragma once

#include "stepping/any_elements.h"
#include "stepping/short_elements.h"

namespace {

/// Asks the memory for a group.
template <class Group>
[[gnu::always_inline]] inline void fetch(const Group* group) {
  constexpr std::size_t kLine = 64;
  for (std::size_t at = 0; at < sizeof(Group); at += kLine) {
    __builtin_prefetch(reinterpret_cast<const char*>(group) + at);
  }
}

template <class Short>
std::uint32_t addAll(const typename Short::Group* groups, std::uint32_t group_count,
                     const double* positions, double* forces, std::uint32_t* hard) {
  constexpr std::uint32_t kAhead = 16;
  Short short_ones(positions, forces);
  std::uint32_t hard_count = 0;
  for (std::uint32_t g = 0; g < group_count; ++g) {
    if (group_count - g > kAhead) fetch(groups + g + kAhead);
    for (std::uint32_t first = 0; first < kGroup; first += kLanes) {
      const Batch<typename Short::Group> batch = {groups + g, first};
      if (short_ones.add(batch)) continue;
      const LaneMask mask = addAny(batch, positions, forces);
      for (int k = 0; k < kLanes; ++k) {
        if (mask[k] != 0) hard[hard_count++] = g * kGroup + first + k;
      }
    }
  }
  short_ones.flush();
  return hard_count;
}

}  // namespace
