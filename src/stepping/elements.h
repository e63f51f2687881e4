// Springs in the order of their particles along the curve, arcs joined with triangles.
#pragma once

#include <algorithm>
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

/// Returns whether a spring is the same when its ends are turned round.
template <class Spring>
constexpr bool isCyclic() {
  return kHasStepKernels<Spring> && Spring::kCorners == Spring::kParticles;
}

/// Returns a spring with the end first whose place is the lowest, where its ends may be turned
/// round, so that rounding does not depend on how it was sent.
template <class Spring>
Spring turned(Spring spring, const std::vector<std::uint32_t>& places) {
  if (isCyclic<Spring>()) {
    auto& ends = spring.particles;
    std::rotate(ends.begin(),
                std::min_element(ends.begin(), ends.end(),
                                 [&](auto a, auto b) { return places[a] < places[b]; }),
                ends.end());
  }
  return spring;
}

/// Returns the numbers that make a spring what it is.
template <class Spring>
std::vector<double> fieldsOf(const Spring& spring) {
  std::vector<double> fields;
  Spring::visitFields(spring,
                      [&](const char*, double value, const Range&) { fields.push_back(value); });
  return fields;
}

template <class Spring>
struct DampedElements : std::vector<Element> {};

/// Returns the springs that are damped, each an element of its own.
PerKind<DampedElements> dampedElementsOf(const System& system,
                                         const std::vector<std::uint32_t>& places);

}  // namespace spherical_springs::core
