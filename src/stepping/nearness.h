// How near is near a place where a condition has no derivative. Kernels only tell whether a spring
// may be that near, with a margin for their rounding.
#pragma once

namespace spherical_springs::core {

// A pair's gradient jumps where its ends meet and where they are antipodal, unless that is the
// angle at rest: near is within a share of the way from there to the angle at rest, as a chord.
inline constexpr double kNearPair = 0.5;
inline constexpr double kNearPairShare = 0.25;

/// Within this norm of (denominator, triple product) a triangle has two nearly antipodal vertices,
/// about which its gradient turns.
inline constexpr double kNearVortex = 1;

/// So near to 2 pi is a difference from the area at rest near the jump that it has there [sr].
inline constexpr double kNearJump = 1;

/// Within so many widths of its change of sign an oriented spring is near it.
inline constexpr double kNearSign = 1.2;

}  // namespace spherical_springs::core
