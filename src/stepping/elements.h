// Springs in the order of their particles along the curve, arcs joined with triangles.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "spherical_springs/system.h"

namespace spherical_springs::core {

constexpr std::uint32_t kNone = ~0u;

/// What a kernel computes at once: an arc, or a triangle with up to two arcs along its edges. Ends
/// are places in the order of particles, the others are indices of springs.
struct Element {
  std::array<std::uint32_t, 3> ends{kNone, kNone, kNone};
  std::uint32_t triangle = kNone;
  std::uint32_t arc = kNone;         ///< from the first end to the second
  std::uint32_t second_arc = kNone;  ///< from the second to the third
};

/// Elements of each sort: arcs alone, and triangles with none, one and two arcs. They depend on the
/// springs, not on the order in which the springs are listed.
struct ElementLists {
  std::vector<Element> arcs;
  std::array<std::vector<Element>, 3> triangles;
};

/// `places`: of each particle in the order.
ElementLists elementsOf(const System& system, const std::vector<std::uint32_t>& places);

}  // namespace spherical_springs::core
