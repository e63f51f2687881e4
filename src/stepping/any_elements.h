// Forces of elements of any size, but for the hard ones.
#pragma once

#include "stepping/near_lanes.h"
#include "stepping/step_batch.h"

namespace {

template <class Group, std::size_t kEnds>
[[gnu::always_inline]] inline void addForces(const Batch<Group>& batch, int first_end,
                                             const Lanes3 (&on)[kEnds], double* forces) {
  for (std::size_t i = 0; i < kEnds; ++i) {
    addRows(on[i], forces, batch.rows(first_end + static_cast<int>(i)));
  }
}

/// Which elements of a batch are hard, and which may be near a place where a condition has no
/// derivative.
struct Places {
  LaneMask hard, near;
};

/// Returns stiffness times condition, which makes forces of slopes; 0 where it is hard.
template <class Formula>
[[gnu::always_inline]] inline Lanes pullOf(const Formula& formula, const LaneConstants& spring,
                                           Places& places) {
  const Lanes value = formula.value(spring.rest);
  places.near |= mayBeNear(formula, spring.rest, value);
  return select0(~places.hard, spring.stiffness * value);
}

Places addAny(const Batch<Arcs>& batch, const double* positions, double* forces) {
  const AngleLanes arc(batch.gather(0, positions), batch.gather(1, positions));
  Places places = {arc.hard, {}};
  Lanes3 on[2];
  arc.slopes(pullOf(arc, LaneConstants(batch, 0), places), on);
  addForces(batch, 0, on, forces);
  return places;
}

// An element is left out whole, with the arcs along its edges, where one of its springs is hard.
template <int kSprings>
Places addAny(const Batch<ElementGroup<3, kSprings>>& batch, const double* positions,
              double* forces) {
  const SolidAngleLanes triangle(batch.gather(0, positions), batch.gather(1, positions),
                                 batch.gather(2, positions));
  const AngleLanes arcs[2] = {{triangle.a, triangle.b}, {triangle.b, triangle.c}};
  Places places = {triangle.hard, {}};
  for (int i = 1; i < kSprings; ++i) places.hard |= arcs[i - 1].hard;
  for (int i = 1; i < kSprings; ++i) {
    Lanes3 on_ends[2];
    arcs[i - 1].slopes(pullOf(arcs[i - 1], LaneConstants(batch, i), places), on_ends);
    addForces(batch, i - 1, on_ends, forces);
  }
  Lanes3 on[3];
  triangle.slopes(pullOf(triangle, LaneConstants(batch, 0), places), on);
  addForces(batch, 0, on, forces);
  return places;
}

Places addAny(const Batch<OrientedArcs>& batch, const double* positions, double* forces) {
  const OrientedAngleLanes oriented(batch.gather(0, positions), batch.gather(1, positions),
                                    batch.gather(2, positions), batch.lanes(batch.group->width));
  Places places = {oriented.hard, {}};
  Lanes3 on[3];
  oriented.slopes(pullOf(oriented, LaneConstants(batch, 0), places), on);
  addForces(batch, 0, on, forces);
  return places;
}

}  // namespace
