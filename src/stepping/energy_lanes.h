// The energies of step_kernels.h, for whatever level of instruction set a file that includes this
// is compiled for.
#pragma once

#include "stepping/step_batch.h"

namespace {

using spherical_springs::core::ElementEnergies;

/// Conditions of an element's springs.
template <int kSprings>
struct LaneConditions {
  Lanes of[kSprings];
  LaneMask hard;
};

inline LaneConditions<1> conditionsOf(const Batch<Arcs>& batch, const double* positions) {
  const AngleLanes arc(batch.gather(0, positions), batch.gather(1, positions));
  return {{arc.value(LaneConstants(batch, 0).rest)}, LaneMask{}};
}

template <int kSprings>
LaneConditions<kSprings> conditionsOf(const Batch<ElementGroup<3, kSprings>>& batch,
                                      const double* positions) {
  const SolidAngleLanes triangle(batch.gather(0, positions), batch.gather(1, positions),
                                 batch.gather(2, positions));
  const Lanes3 corners[3] = {triangle.a, triangle.b, triangle.c};
  LaneConditions<kSprings> conditions;
  conditions.of[0] = triangle.value(LaneConstants(batch, 0).rest);
  for (int i = 1; i < kSprings; ++i) {
    conditions.of[i] = AngleLanes(corners[i - 1], corners[i]).value(LaneConstants(batch, i).rest);
  }
  conditions.hard = triangle.hard;
  return conditions;
}

inline LaneConditions<1> conditionsOf(const Batch<OrientedArcs>& batch, const double* positions) {
  const OrientedAngleLanes oriented(batch.gather(0, positions), batch.gather(1, positions),
                                    batch.gather(2, positions), batch.lanes(batch.group->width));
  return {{oriented.value(LaneConstants(batch, 0).rest)}, oriented.is_sharp};
}

/// Which elements have their first end below an offset.
template <class Group>
[[gnu::always_inline]] inline LaneMask firstEndBelow(const Batch<Group>& batch,
                                                     std::uint32_t limit) {
  LaneMask result;
  for (int k = 0; k < kLanes; ++k) result[k] = batch.rows(0)[k] < limit ? -1 : 0;
  return result;
}

template <class Group, int kSprings>
std::uint32_t addEnergies(const Group* groups, std::uint32_t group_count, const double* positions,
                          std::uint32_t limit, ElementEnergies& energies, std::uint32_t* hard) {
  Lanes sums[kSprings] = {};
  std::uint32_t hard_count = 0;
  for (std::uint32_t g = 0; g < group_count; ++g) {
    for (std::uint32_t first = 0; first < kGroup; first += kLanes) {
      const Batch<Group> batch = {groups + g, first};
      const LaneConditions<kSprings> conditions = conditionsOf(batch, positions);
      const LaneMask counted = firstEndBelow(batch, limit);
      for (int i = 0; i < kSprings; ++i) {
        const Lanes stiffness = LaneConstants(batch, i).stiffness;
        const Lanes energy = 0.5 * stiffness * conditions.of[i] * conditions.of[i];
        sums[i] += select0(counted & ~conditions.hard, energy);
      }
      const LaneMask left = counted & conditions.hard;
      for (int k = 0; k < kLanes; ++k) {
        if (left[k] != 0) hard[hard_count++] = g * kGroup + first + k;
      }
    }
  }
  energies.first += sum(sums[0]);
  for (int i = 1; i < kSprings; ++i) energies.arcs += sum(sums[i]);
  return hard_count;
}

}  // namespace
