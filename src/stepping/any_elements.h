// Forces of elements of any size, but for the hard ones.
#pragma once

#include "stepping/step_batch.h"

namespace {

template <class Group, std::size_t kEnds>
[[gnu::always_inline]] inline void addForces(const Batch<Group>& batch, int first_end,
                                             const Lanes3 (&on)[kEnds], double* forces) {
  for (std::size_t i = 0; i < kEnds; ++i) {
    addRows(on[i], forces, batch.rows(first_end + static_cast<int>(i)));
  }
}

/// Returns stiffness times condition, which makes forces of slopes; 0 where it is hard.
template <class Formula>
[[gnu::always_inline]] inline Lanes pullOf(const Formula& formula, const LaneConstants& spring,
                                           const LaneMask& hard) {
  return select0(~hard, spring.stiffness * formula.value(spring.rest));
}

LaneMask addAny(const Batch<Arcs>& batch, const double* positions, double* forces) {
  const AngleLanes arc(batch.gather(0, positions), batch.gather(1, positions));
  Lanes3 on[2];
  arc.slopes(pullOf(arc, LaneConstants(batch, 0), arc.hard), on);
  addForces(batch, 0, on, forces);
  return arc.hard;
}

// An element is left out whole, with the arcs along its edges, where one of its springs is hard.
template <int kSprings>
LaneMask addAny(const Batch<ElementGroup<3, kSprings>>& batch, const double* positions,
                double* forces) {
  const SolidAngleLanes triangle(batch.gather(0, positions), batch.gather(1, positions),
                                 batch.gather(2, positions));
  const AngleLanes arcs[2] = {{triangle.a, triangle.b}, {triangle.b, triangle.c}};
  LaneMask hard = triangle.hard;
  for (int i = 1; i < kSprings; ++i) hard |= arcs[i - 1].hard;
  for (int i = 1; i < kSprings; ++i) {
    Lanes3 on_ends[2];
    arcs[i - 1].slopes(pullOf(arcs[i - 1], LaneConstants(batch, i), hard), on_ends);
    addForces(batch, i - 1, on_ends, forces);
  }
  Lanes3 on[3];
  triangle.slopes(pullOf(triangle, LaneConstants(batch, 0), hard), on);
  addForces(batch, 0, on, forces);
  return hard;
}

LaneMask addAny(const Batch<OrientedArcs>& batch, const double* positions, double* forces) {
  const OrientedAngleLanes oriented(batch.gather(0, positions), batch.gather(1, positions),
                                    batch.gather(2, positions), batch.lanes(batch.group->width));
  Lanes3 on[3];
  oriented.slopes(pullOf(oriented, LaneConstants(batch, 0), oriented.hard), on);
  addForces(batch, 0, on, forces);
  return oriented.hard;
}

}  // namespace
