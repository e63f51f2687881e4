// Geometry of the unit sphere: arcs, rotations, solid angles.
//
// Points are unit vectors in one right-handed frame. Formulas are chosen to keep their relative
// accuracy where the textbook ones cancel: short arcs, small triangles, nearly antipodal pairs.
#pragma once

#include <Eigen/Geometry>

#include "spherical_springs/matrices.h"

/// Geometry, springs, scenes, stepping and relaxation; no ROS.
namespace spherical_springs::core {

inline constexpr double kPi = 3.14159265358979323846;  ///< half a turn [rad]

/// Direction of any finite non-zero vector, whatever its magnitude. A vector that already has unit
/// length to rounding comes back unchanged, so that a saved position is read back to the last bit.
Vector3 direction(const Vector3& vector);

/// One unit vector normal to the unit vector `p`, the same at every call.
Vector3 perpendicular(const Vector3& p);

/// Two unit vectors that make a right-handed frame with a point: columns x and y = p x x.
using TangentFrame = Unaligned<double, 3, 2>;

/// The frame at `p` whose x is `perpendicular(p)`.
inline TangentFrame tangentFrame(const Vector3& p) {
  TangentFrame frame;
  frame.col(0) = perpendicular(p);
  frame.col(1) = p.cross(frame.col(0));
  return frame;
}

/// `a x b` of unit vectors from their difference and sum, which does not cancel where `a` and `b`
/// are close or nearly antipodal.
inline Vector3 crossOfUnits(const Vector3& a, const Vector3& b) {
  return 0.5 * (a - b).cross(a + b);
}

/// `a + b` of unit vectors, as if they had been normalised without rounding where they are nearly
/// antipodal and the rounding would be a large share of the sum.
Vector3 sumOfUnits(const Vector3& a, const Vector3& b);

/// The great-circle arc from `a` to `b`.
struct Arc {
  double angle;  ///< in [0, pi] [rad]
  Vector3 axis;  ///< unit vector; a rotation about it carries `a` towards `b`
};

/// Coinciding or antipodal points have no axis of their own: there it is `perpendicular(a)`.
/// \snippet test_headers.cpp sphere
Arc arc(const Vector3& a, const Vector3& b);

/// The invariants of a spherical triangle from which its solid angle and gradients come, after
/// Oosterom and Strackee 1983: tan(solid angle / 2) = triple_product / denominator.
struct Triangle {
  double triple_product;  ///< a . (b x c); positive for vertices counter-clockwise from outside
  double denominator;     ///< 1 + a.b + b.c + c.a
  /// triple_product^2 + denominator^2; 0 for a pair of vertices that is antipodal to within 1e-30,
  /// far below what rounding leaves of most positions, so that gradients of the area stay below
  /// 4e30.
  double squared_norm;
};

/// Returns the invariants of the triangle of three unit vectors.
Triangle triangle(const Vector3& a, const Vector3& b, const Vector3& c);

/// a . (b x c), accurate for small triangles and nearly antipodal pairs.
double tripleProduct(const Vector3& a, const Vector3& b, const Vector3& c);

/// Signed area of the spherical triangle [sr], in (-2 pi, 2 pi]; 0 where two vertices are antipodal
/// and it is undefined.
double solidAngle(const Vector3& a, const Vector3& b, const Vector3& c);

/// `p` rotated by the rotation vector `rotation` [rad], which must be normal to `p`; of unit
/// length.
Vector3 rotated(const Vector3& p, const Vector3& rotation);

/// Drops the part of `angular_velocity` along the position, and with it what is only its rounding;
/// one that is normal to the position to rounding stays as it is, to the last bit.
Vector3 tangentPart(const Vector3& position, const Vector3& angular_velocity);

}  // namespace spherical_springs::core
