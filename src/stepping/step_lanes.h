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

using spherical_springs::core::MarkedElements;

inline void mark(const Places& places, std::uint32_t first, MarkedElements& marked) {
  for (int k = 0; k < kLanes; ++k) {
    if (places.hard[k] != 0) {
      marked.hard[marked.hard_count++] = first + k;
    } else if (places.near[k] != 0) {
      marked.near[marked.near_count++] = first + k;
    }
  }
}

template <class Short>
void addAll(const typename Short::Group* groups, std::uint32_t group_count, const double* positions,
            double* forces, MarkedElements& marked) {
  constexpr std::uint32_t kAhead = 16;
  Short short_ones(positions, forces);
  for (std::uint32_t g = 0; g < group_count; ++g) {
    if (group_count - g > kAhead) fetch(groups + g + kAhead);
    for (std::uint32_t first = 0; first < kGroup; first += kLanes) {
      const Batch<typename Short::Group> batch = {groups + g, first};
      if (short_ones.add(batch)) continue;
      const Places places = addAny(batch, positions, forces);
      if (any(places.hard | places.near)) mark(places, g * kGroup + first, marked);
    }
  }
  short_ones.flush();
}

}  // namespace
