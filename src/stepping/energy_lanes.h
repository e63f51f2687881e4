// The energies of step_kernels.h, for whatever level of instruction set a file that includes this
// is compiled for.
#pragma once

#include "stepping/any_elements.h"

namespace {

using spherical_springs::core::ElementEnergies;

/// Conditions of an element's springs.
template <int kSprings>
struct LaneConditions {
  Lanes of[kSprings];
  LaneMask hard;
};

[[gnu::always_inline]] inline Lanes arcCondition(const Lanes3& a, const Lanes3& b,
                                                 const Lanes& rest) {
  return anyAngle(a, b).value - rest;
}

inline LaneConditions<1> conditionsOf(const Batch<Arcs>& batch, const double* positions) {
  return {{arcCondition(batch.gather(0, positions), batch.gather(1, positions),
                        LaneConstants(batch, 0).rest)},
          LaneMask{}};
}

template <int kSprings>
LaneConditions<kSprings> conditionsOf(const Batch<ElementGroup<3, kSprings>>& batch,
                                      const double* positions) {
  const Lanes3 corners[3] = {batch.gather(0, positions), batch.gather(1, positions),
                             batch.gather(2, positions)};
  const TriangleEdges e(corners[0], corners[1], corners[2]);
  LaneConditions<kSprings> conditions;
  conditions.of[0] = areaDifference(e.triple_product, e.denominator, LaneConstants(batch, 0).rest);
  for (int i = 1; i < kSprings; ++i) {
    conditions.of[i] = arcCondition(corners[i - 1], corners[i], LaneConstants(batch, i).rest);
  }
  conditions.hard = isNearlyAntipodal(e.squaredNorm());
  return conditions;
}

inline LaneConditions<1> conditionsOf(const Batch<OrientedArcs>& batch, const double* positions) {
  const Lanes3 a = batch.gather(0, positions), b = batch.gather(1, positions),
               c = batch.gather(2, positions);
  const Lanes width = load(batch.group->width + batch.first);
  const LaneSign sign = signOf(TriangleEdges(a, b, c).triple_product / width);
  const Lanes rest = load(batch.group->rest + batch.first);
  return {{sign.value * anyAngle(a, b).value - rest}, width <= 0};
}

template <int kEnds, int kSprings>
[[gnu::always_inline]] inline Lanes stiffnessOf(const Batch<ElementGroup<kEnds, kSprings>>& batch,
                                                int spring) {
  return LaneConstants(batch, spring).stiffness;
}
[[gnu::always_inline]] inline Lanes stiffnessOf(const Batch<OrientedArcs>& batch, int) {
  return load(batch.group->stiffness + batch.first);
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
        const Lanes energy = 0.5 * stiffnessOf(batch, i) * conditions.of[i] * conditions.of[i];
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
