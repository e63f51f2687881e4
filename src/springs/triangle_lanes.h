// Derivatives of the areas of spherical triangles, several triangles at a time, for kernels of
// springs and of maps. The formulas are those of solid_angle.cpp, for triangles that are not large.
#pragma once

#include "base/lanes.h"
#include "geometry/place_size.h"

namespace {

/// Two tangent coordinates.
struct Lanes2 {
  Lanes x, y;
};

inline Lanes2 operator+(const Lanes2& a, const Lanes2& b) { return {a.x + b.x, a.y + b.y}; }
inline Lanes2 operator*(const Lanes& s, const Lanes2& a) { return {s * a.x, s * a.y}; }

struct LaneBlock {
  Lanes xx, yx, xy, yy;  // by columns
};

inline LaneBlock operator+(const LaneBlock& a, const LaneBlock& b) {
  return {a.xx + b.xx, a.yx + b.yx, a.xy + b.xy, a.yy + b.yy};
}
inline LaneBlock outer(const Lanes2& a, const Lanes2& b) {
  return {a.x * b.x, a.y * b.x, a.x * b.y, a.y * b.y};
}
inline LaneBlock scaled(const Lanes& factor, const LaneBlock& b) {
  return {factor * b.xx, factor * b.yx, factor * b.xy, factor * b.yy};
}

struct LaneFrame {
  Lanes3 point, x, y;

  /// Tangent coordinates of a vector.
  Lanes2 coordinates(const Lanes3& v) const { return {dot(x, v), dot(y, v)}; }
};

/// Four successive numbers of the row of each lane, `stride` numbers apart, one Lanes for each of
/// the four.
inline void gather(const double* first, std::size_t stride, const std::uint32_t* rows,
                   Lanes* const (&fields)[4]) {
  for (int part = 0; part < kLanes / 4; ++part) {
    Four numbers[4];
    for (int k = 0; k < 4; ++k) numbers[k] = loadFour(first + stride * rows[4 * part + k]);
    transpose(numbers);
    for (int k = 0; k < 4; ++k) setFour(numbers[k], part, *fields[k]);
  }
}

/// The tangent place of the row of each lane.
inline void gather(const double* places, const std::uint32_t* rows, LaneFrame& end) {
  using spherical_springs::core::kPlaceSize;
  gather(places, kPlaceSize, rows, {&end.x.x, &end.x.y, &end.x.z, &end.y.x});
  gather(places + 4, kPlaceSize, rows, {&end.y.y, &end.y.z, &end.point.x, &end.point.y});
  for (int k = 0; k < kLanes; ++k) end.point.z[k] = places[kPlaceSize * rows[k] + 8];
}

/// frame_a^T (b [c]_x + a I) frame_b for scalars a and b.
inline LaneBlock mixed(const LaneFrame& a, const LaneFrame& b, const Lanes3& c, const Lanes& beta,
                       const Lanes& alpha) {
  const Lanes3 cx = beta * cross(c, b.x) + alpha * b.x;
  const Lanes3 cy = beta * cross(c, b.y) + alpha * b.y;
  const Lanes2 first = a.coordinates(cx), second = a.coordinates(cy);
  return {first.x, first.y, second.x, second.y};
}

/// The derivatives of the area of a triangle at one corner. The area is 2 arg z, where z is the
/// denominator + i times the triple product; u and v are the real and the imaginary part of
/// (grad z) / z, and `radial` is the share of the curvature of the sphere.
struct CornerSlope {
  Lanes2 u, v;
  Lanes radial;

  /// The corner's block of stiffness v v^T + bend (u v^T + v u^T + radial I); the area itself has
  /// that of bend -2.
  LaneBlock block(const Lanes& stiffness, const Lanes& bend) const {
    const Lanes2 bend_u = bend * u;
    LaneBlock result = outer(stiffness * v + bend_u, v) + outer(v, bend_u);
    result.xx += bend * radial;
    result.yy += bend * radial;
    return result;
  }
};

/// The slope at a corner with the others in the positive sense; alpha and beta are triple product
/// and denominator over the sum of their squares. A vector has the same coordinates at a corner as
/// its difference from that, which does not cancel.
inline CornerSlope cornerSlope(const LaneFrame& corner, const Lanes3& next, const Lanes3& last,
                               const Lanes& alpha, const Lanes& beta) {
  const Lanes3 side = last - next;
  const Lanes2 across = corner.coordinates(0.5 * cross(next + last, side));
  const Lanes2 along = corner.coordinates((next - corner.point) + (last - corner.point));
  return {beta * along + alpha * across, beta * across + -alpha * along,
          alpha * (2 - 0.5 * dot(side, side))};
}

/// The block of a corner and the next one of stiffness v v^T + bend (u v^T + v u^T + mixed).
inline LaneBlock coupling(const LaneFrame (&corners)[3], const CornerSlope (&slopes)[3], int first,
                          const Lanes& stiffness, const Lanes& bend, const Lanes& alpha,
                          const Lanes& beta) {
  const int second = (first + 1) % 3, third = (first + 2) % 3;
  const Lanes2 stiff_v = stiffness * slopes[first].v + bend * slopes[first].u;
  return outer(stiff_v, slopes[second].v) + outer(bend * slopes[first].v, slopes[second].u) +
         scaled(bend, mixed(corners[first], corners[second], corners[third].point, beta, alpha));
}

}  // namespace
