// Elements of step_kernels.h as the lanes of a batch.
#pragma once

#include "base/lanes.h"
#include "springs/spring_lanes.h"
#include "stepping/rows.h"
#include "stepping/step_kernels.h"

namespace {

using spherical_springs::core::Arcs;
using spherical_springs::core::ElementGroup;
using spherical_springs::core::kGroup;
using spherical_springs::core::OrientedArcs;
using spherical_springs::core::Triangles;

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
  [[gnu::always_inline]] Lanes lanes(const double (&values)[kGroup]) const {
    return load(values + first);
  }
};

/// Constants of the springs of a batch.
struct LaneConstants {
  Lanes rest, stiffness;

  template <class Group>
  [[gnu::always_inline]] LaneConstants(const Batch<Group>& batch, int spring)
      : rest(batch.lanes(batch.group->springs[spring].rest)),
        stiffness(batch.lanes(batch.group->springs[spring].stiffness)) {}
};

}  // namespace
