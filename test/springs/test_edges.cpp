// The formulas of the sphere and of the solid angle against arithmetic of 113 bits.
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <limits>

#include "spherical_springs/sphere.h"
#include "spherical_springs/springs/solid_angle.h"
#include "support/scenes.h"

namespace spherical_springs::core {
namespace {

using testing::Random;
using Quad = boost::multiprecision::cpp_bin_float_quad;
using Triple = std::array<Vector3, 3>;

constexpr double kUlp = std::numeric_limits<double>::epsilon();

struct QuadVector {
  Quad x, y, z;
};
QuadVector operator+(const QuadVector& a, const QuadVector& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
QuadVector operator-(const QuadVector& a, const QuadVector& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
QuadVector operator*(const Quad& s, const QuadVector& a) { return {s * a.x, s * a.y, s * a.z}; }
Quad dot(const QuadVector& a, const QuadVector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
QuadVector cross(const QuadVector& a, const QuadVector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Quad norm(const QuadVector& a) { return sqrt(dot(a, a)); }

QuadVector exact(const Vector3& v) { return {v.x(), v.y(), v.z()}; }
QuadVector exactDirection(const Vector3& v) { return 1 / norm(exact(v)) * exact(v); }

double relativeError(double value, const Quad& expected) {
  return static_cast<double>(abs((value - expected) / expected));
}

double relativeError(const Vector3& value, const QuadVector& expected) {
  return static_cast<double>(norm(exact(value) - expected) / norm(expected));
}

void expectArcWithin4Ulp(const Vector3& a, const Vector3& b) {
  const Arc between = arc(a, b);
  const QuadVector normal = cross(exactDirection(a), exactDirection(b));
  if (norm(normal) == 0) return;
  const Quad angle = atan2(norm(normal), dot(exactDirection(a), exactDirection(b)));
  EXPECT_LT(relativeError(between.angle, angle), 4 * kUlp) << angle;
  EXPECT_LT(relativeError(between.axis, 1 / norm(normal) * normal), 4 * kUlp) << angle;
}

TEST(Edges, ArcsFromZeroToPi) {
  Random random(1);
  for (double angle = 1e-15; angle < 1.6; angle *= 3) {
    for (int trial = 0; trial < 100; ++trial) {
      const Vector3 a = random.unitVector();
      const Vector3 axis = a.cross(random.unitVector()).normalized();
      const Vector3 b = rotated(a, angle * axis);
      expectArcWithin4Ulp(a, b);
      expectArcWithin4Ulp(a, -b);
    }
  }
}

/// Solid angle and torques of `points` against the same formulas in 113 bits.
void expectTriangleWithin(double tolerance, const Triple& points) {
  const QuadVector a = exactDirection(points[0]);
  const QuadVector b = exactDirection(points[1]);
  const QuadVector c = exactDirection(points[2]);
  const Quad alpha = dot(a, cross(b, c));
  const Quad beta = 1 + dot(a, b) + dot(b, c) + dot(c, a);
  if (alpha == 0) return;
  const double area = solidAngle(points[0], points[1], points[2]);
  EXPECT_LT(relativeError(area, 2 * atan2(alpha, beta)), tolerance);

  const auto computed = condition(SolidAngleSpring(), points);
  const auto gradient = [&](const QuadVector& p, const QuadVector& q, const QuadVector& r) {
    const Quad scale = 2 / (alpha * alpha + beta * beta);
    return cross(p, scale * (beta * cross(q, r) - alpha * (q + r)));
  };
  EXPECT_LT(relativeError(computed.gradient[0], gradient(a, b, c)), tolerance);
  EXPECT_LT(relativeError(computed.gradient[1], gradient(b, c, a)), tolerance);
  EXPECT_LT(relativeError(computed.gradient[2], gradient(c, a, b)), tolerance);
}

template <class Make>
void expectTrianglesWithin(double tolerance, double smallest_size, const Make& make) {
  for (double size = 1; size >= smallest_size; size /= 10) {
    SCOPED_TRACE(size);
    for (int trial = 0; trial < 200; ++trial) expectTriangleWithin(tolerance, make(size));
  }
}

TEST(Edges, SmallTriangles) {
  Random random(2);
  expectTrianglesWithin(1e-12, 1e-8, [&](double size) {
    Triple p = random.unitVectors<3>();
    for (int i = 1; i < 3; ++i) p[i] = (p[0] + size * (p[i] - p[0])).normalized();
    return p;
  });
}

TEST(Edges, TrianglesWithOneShortEdge) {
  Random random(3);
  expectTrianglesWithin(1e-12, 1e-8, [&](double size) {
    Triple p = random.unitVectors<3>();
    p[2] = (p[1] + size * p[2]).normalized();
    return p;
  });
}

TEST(Edges, TrianglesBesideAGreatCircle) {
  Random random(4);
  expectTrianglesWithin(1e-12, 1e-13, [&](double size) {
    const Vector3 pole = random.unitVector();
    const Vector3 x = perpendicular(pole);
    Triple p;
    for (int i = 0; i < 3; ++i) {
      const Vector3 on_circle = rotated(x, (2.1 * i + random.between(-0.3, 0.3)) * pole);
      p[i] = (on_circle + size * random.between(-1, 1) * pole).normalized();
    }
    return p;
  });
}

TEST(Edges, TrianglesBesideAnAntipodalPair) {
  Random random(5);
  expectTrianglesWithin(1e-12, 1e-12, [&](double size) {
    Triple p = random.unitVectors<3>();
    p[1] = (size * p[1] - p[0]).normalized();
    return p;
  });
}

}  // namespace
}  // namespace spherical_springs::core
