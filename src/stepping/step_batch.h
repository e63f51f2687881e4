// Elements of step_kernels.h as the lanes of a batch.
#pragma once

#include "base/lanes.h"
#include "stepping/rows.h"
#include "stepping/step_kernels.h"

namespace {

using spherical_springs::core::Arcs;
using spherical_springs::core::ElementGroup;
using spherical_springs::core::kGroup;
using spherical_springs::core::OrientedArcs;
using spherical_springs::core::Triangles;

constexpr double kShortest = 1e-16;  // of a quarter of a squared chord, and of its supplement

/// Some elements of a group, one in each lane.
template <class Group>
struct Batch {
  const Group* group;
  std::size_t first;  ///< in the group

  [[gnu::always_inline]] const std::uint32_t* rows(int end) const {
    return group->ends[end] + first;
  }
  [[gnu::always_inline]] Lanes3 gather(int end, const double* positions) const {
    return gatherRows(positions, rows(end));
  }
};

/// Constants of the springs of a batch.
struct LaneConstants {
  Lanes rest, stiffness;

  template <class Group>
  [[gnu::always_inline]] LaneConstants(const Batch<Group>& batch, int spring)
      : rest(load(batch.group->springs[spring].rest + batch.first)),
        stiffness(load(batch.group->springs[spring].stiffness + batch.first)) {}
};

struct TriangleEdges {
  Lanes3 ab, bc, ca;
  Lanes squared_ab, squared_bc, squared_ca;
  Lanes3 area;  ///< a x b + b x c + c x a
  Lanes triple_product, denominator;

  TriangleEdges(const Lanes3& a, const Lanes3& b, const Lanes3& c)
      : ab(b - a),
        bc(c - b),
        ca(a - c),
        squared_ab(dot(ab, ab)),
        squared_bc(dot(bc, bc)),
        squared_ca(dot(ca, ca)),
        area(cross(ca, ab)),
        triple_product(dot(a, area)),
        denominator(4 - 0.5 * (squared_ab + squared_bc + squared_ca)) {}

  Lanes squaredNorm() const { return triple_product * triple_product + denominator * denominator; }
};

}  // namespace
