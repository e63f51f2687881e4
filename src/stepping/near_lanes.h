// Whether springs may be near a place where their conditions have no derivative, in lanes.
#pragma once

#include "springs/spring_lanes.h"
#include "stepping/nearness.h"

namespace {

constexpr double kNearMargin = 1.01;  // above the rounding of kernels and formulas

/// Returns whether a pair with a quarter of its squared chord and of its supplement's is near.
[[gnu::always_inline]] inline LaneMask mayPairBeNear(const Lanes& meeting, const Lanes& antipode,
                                                     const Lanes& rest) {
  using namespace spherical_springs::core;
  constexpr double kFarthest = kNearMargin * kNearPair * kNearPair / 4;
  const LaneMask candidates = (meeting < kFarthest) | (antipode < kFarthest);
  if (!any(candidates)) return candidates;
  constexpr double kShare = kNearMargin * kNearPairShare * kNearPairShare / 4;
  const Lanes supplement = kPi - rest;
  return ((meeting < kFarthest) & (meeting < kShare * rest * rest)) |
         ((antipode < kFarthest) & (antipode < kShare * supplement * supplement));
}

[[gnu::always_inline]] inline LaneMask mayBeNear(const AngleLanes& arc, const Lanes& rest,
                                                 const Lanes&) {
  return mayPairBeNear(arc.near, arc.far, rest);
}

[[gnu::always_inline]] inline LaneMask mayBeNear(const SolidAngleLanes& triangle, const Lanes&,
                                                 const Lanes& difference) {
  using namespace spherical_springs::core;
  constexpr double kVortex = kNearMargin * kNearVortex * kNearVortex;
  constexpr double kJump = 2 * kPi - kNearMargin * kNearJump;
  return ~(triangle.squared_norm >= kVortex) | (absolute(difference) > kJump);
}

[[gnu::always_inline]] inline LaneMask mayBeNear(const OrientedAngleLanes& oriented,
                                                 const Lanes& rest, const Lanes&) {
  using namespace spherical_springs::core;
  const AngleLanes& arc = oriented.between;
  return mayPairBeNear(arc.near, arc.far, absolute(rest)) |
         (absolute(oriented.e.triple_product) <= kNearMargin * kNearSign * oriented.width);
}

}  // namespace
