// Springs in the order of their particles along the curve, arcs joined with triangles.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "spherical_springs/system.h"
#include "stepping/plain_springs.h"

namespace spherical_springs::core {

inline constexpr std::uint32_t kNone = ~0u;

/// The unit that a kernel computes at once: a spring, or a triangle with up to two arcs along its
/// edges.
struct Element {
  std::array<std::uint32_t, kMostEnds> ends;  ///< places in the order of particles, or kNone
  /// Indices of springs: of the only one; or of the triangle, of the arc from its first end to its
  /// second, and of that from its second to its third.
  std::array<std::uint32_t, 3> springs{kNone, kNone, kNone};
};

/// Elements of each of the `Sorts`, in an order that depends on the springs, not on how they are
/// listed.
struct ElementLists {
  std::array<std::vector<Element>, kSortCount> of;
  /// Whether several springs of a kind join the same particles, whose order depends on their
  /// numbers.
  bool any_parallel = false;
};

/// `places`: of each particle in the order.
ElementLists elementsOf(const System& system, const std::vector<std::uint32_t>& places);

template <class Spring>
struct DampedElements : std::vector<Element> {};

/// Returns the springs that are damped, each an element of its own.
PerKind<DampedElements> dampedElementsOf(const System& system,
                                         const std::vector<std::uint32_t>& places);

}  // namespace spherical_springs::core
