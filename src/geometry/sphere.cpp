#include "spherical_springs/sphere.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace spherical_springs::core {

Vector3 direction(const Vector3& vector) {
  constexpr double kUnitTolerance = 8 * std::numeric_limits<double>::epsilon();
  if (std::abs(vector.squaredNorm() - 1) <= kUnitTolerance) return vector;
  const Vector3 scaled = vector / vector.cwiseAbs().maxCoeff();
  return scaled.normalized();
}

Vector3 perpendicular(const Vector3& p) {
  Eigen::Index smallest;
  p.cwiseAbs().minCoeff(&smallest);
  return p.cross(Vector3::Unit(smallest)).normalized();
}

namespace {

/// |p|^2 - 1 to nearly twice the working precision, after the compensated dot product of T. Ogita,
/// S. M. Rump and S. Oishi, SIAM J. Sci. Comput. 26 (2005).
double squaredNormExcess(const Vector3& p) {
  double sum = -1;
  double error = 0;
  for (int k = 0; k < 3; ++k) {
    const double component = p[k];
    const double square = component * component;
    error += std::fma(component, component, -square);
    const double next = sum + square;
    const double part = next - sum;
    error += (sum - (next - part)) + (square - part);
    sum = next;
  }
  return sum + error;
}

}  // namespace

Vector3 sumOfUnits(const Vector3& a, const Vector3& b) {
  constexpr double kNearlyAntipodal = 0.01;
  Vector3 sum = a + b;
  if (sum.squaredNorm() > kNearlyAntipodal) return sum;
  return sum - 0.5 * (squaredNormExcess(a) * a + squaredNormExcess(b) * b);
}

Arc arc(const Vector3& a, const Vector3& b) {
  const Vector3 cross = crossOfUnits(a, b);
  const double sine = cross.norm();
  return {std::atan2(sine, a.dot(b)), sine > 0 ? Vector3(cross / sine) : perpendicular(a)};
}

namespace {

/// The vertices turned, keeping their cyclic order, so that the edge first-second is the longest.
struct LongestEdgeFirst {
  Vector3 first, second, third;

  LongestEdgeFirst(const Vector3& a, const Vector3& b, const Vector3& c)
      : first(a), second(b), third(c) {
    const double ab = (a - b).squaredNorm();
    const double bc = (b - c).squaredNorm();
    const double ca = (c - a).squaredNorm();
    if (bc > ab && bc >= ca) {
      *this = LongestEdgeFirst(b, c, a, Turned());
    } else if (ca > ab) {
      *this = LongestEdgeFirst(c, a, b, Turned());
    }
  }

 private:
  struct Turned {};
  LongestEdgeFirst(const Vector3& a, const Vector3& b, const Vector3& c, Turned)
      : first(a), second(b), third(c) {}
};

/// The differences that are exact decide the form: edges of a small triangle, or the sum of a
/// nearly antipodal pair.
double tripleProduct(const LongestEdgeFirst& t) {
  const Vector3 to_first = t.first - t.third;
  const Vector3 to_second = t.second - t.third;
  const double shortest = std::min(to_first.squaredNorm(), to_second.squaredNorm());
  if ((t.first + t.second).squaredNorm() < shortest) {
    return t.third.dot(crossOfUnits(t.first, t.second));
  }
  return t.third.dot(to_first.cross(to_second));
}

}  // namespace

double tripleProduct(const Vector3& a, const Vector3& b, const Vector3& c) {
  return tripleProduct(LongestEdgeFirst(a, b, c));
}

Triangle triangle(const Vector3& a, const Vector3& b, const Vector3& c) {
  constexpr double kUndefined = 1e-60;
  const LongestEdgeFirst t(a, b, c);
  const Vector3 sum = sumOfUnits(t.first, t.second);
  const double squared_sum = sum.squaredNorm();
  Triangle result;
  result.triple_product = tripleProduct(t);
  result.denominator = 0.5 * squared_sum + sum.dot(t.third);
  result.squared_norm =
      0.25 * squared_sum * (t.second + t.third).squaredNorm() * (t.third + t.first).squaredNorm();
  if (result.squared_norm < kUndefined) result.squared_norm = 0;
  return result;
}

double solidAngle(const Vector3& a, const Vector3& b, const Vector3& c) {
  const Triangle t = triangle(a, b, c);
  return t.squared_norm > 0 ? 2 * std::atan2(t.triple_product, t.denominator) : 0;
}

namespace {

struct Turn {
  double cosine;
  double sinc;  ///< sin(angle) / angle
};

/// Below half a radian by Taylor's series, whose first term left out is 1e-18: a third of the time.
Turn turnBy(double squared_angle) {
  constexpr double kSmall = 0.25;
  const double x = squared_angle;
  if (x > kSmall) {
    const double angle = std::sqrt(x);
    return {std::cos(angle), std::sin(angle) / angle};
  }
  constexpr double kCosine[] = {-1. / 87178291200, 1. / 479001600, -1. / 3628800, 1. / 40320,
                                -1. / 720,         1. / 24,        -1. / 2,       1};
  constexpr double kSinc[] = {-1. / 1307674368000, 1. / 6227020800, -1. / 39916800, 1. / 362880,
                              -1. / 5040,          1. / 120,        -1. / 6,        1};
  double cosine = 0;
  double sinc = 0;
  for (int n = 0; n < 8; ++n) {
    cosine = kCosine[n] + x * cosine;
    sinc = kSinc[n] + x * sinc;
  }
  return {cosine, sinc};
}

}  // namespace

Vector3 rotated(const Vector3& p, const Vector3& rotation) {
  const double squared_angle = rotation.squaredNorm();
  if (squared_angle == 0) return p;
  const Turn turn = turnBy(squared_angle);
  const Vector3 moved = turn.cosine * p + turn.sinc * rotation.cross(p);
  return moved * (1.5 - 0.5 * moved.squaredNorm());
}

Vector3 tangentPart(const Vector3& position, const Vector3& angular_velocity) {
  constexpr double kNormalTolerance = 4 * std::numeric_limits<double>::epsilon();
  Vector3 tangent = angular_velocity;
  for (int i = 0; i < 3; ++i) {  // more than once where little is left beside what is dropped
    const double along = position.dot(tangent);
    if (std::abs(along) <= kNormalTolerance * tangent.norm()) break;
    tangent -= along * position;
    if (tangent.norm() <= kNormalTolerance * angular_velocity.norm()) return Vector3::Zero();
  }
  return tangent;
}

}  // namespace spherical_springs::core
