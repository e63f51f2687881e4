// Springs in the order of their particles along the curve, arcs joined with triangles.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "spherical_springs/system.h"

namespace spherical_springs::core {

inline constexpr std::uint32_t kNone = ~0u;

/// The unit that a kernel computes at once: an arc, a triangle with up to two arcs along its edges,
/// or an oriented arc.
struct Element {
  std::array<std::uint32_t, 3> ends{kNone, kNone, kNone};  ///< places in the order of particles
  /// Indices of springs: of the arc; or of the triangle, of the arc from its first end to its
  /// second, and of that from its second to its third.
  std::array<std::uint32_t, 3> springs{kNone, kNone, kNone};
};

/// Arcs alone; triangles with no, one and two arcs; oriented arcs. In an order that depends on the
/// springs, not on how they are listed.
using ElementLists = std::array<std::vector<Element>, 5>;

/// `places`: of each particle in the order.
ElementLists elementsOf(const System& system, const std::vector<std::uint32_t>& places);

/// The springs of a kind that are damped, each an element of its own.
template <class Spring>
std::vector<Element> dampedElementsOf(const System& system,
                                      const std::vector<std::uint32_t>& places);

}  // namespace spherical_springs::core
