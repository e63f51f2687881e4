#include "spherical_springs/springs/solid_angle.h"

#include <cmath>

#include "springs/skew.h"
#include "springs/solid_angle_value.h"

namespace spherical_springs::core {
namespace {

/// `angle` - `rest`, both in (-2 pi, 2 pi], modulo 4 pi into [-2 pi, 2 pi]: continuous where the
/// vertices pass over a great circle.
double wrappedDifference(double angle, double rest) {
  const double difference = angle - rest;
  if (difference > 2 * kPi) return difference - 4 * kPi;
  if (difference < -2 * kPi) return difference + 4 * kPi;
  return difference;
}

}  // namespace

double conditionValue(const SolidAngleSpring& spring, const Triangle& triangle) {
  const bool is_defined = triangle.squared_norm > 0;
  const double angle =
      is_defined ? 2 * std::atan2(triangle.triple_product, triangle.denominator) : 0;
  return wrappedDifference(angle, spring.rest_solid_angle);
}

void rest(SolidAngleSpring& spring, const std::array<Vector3, 3>& points) {
  spring.rest_solid_angle = solidAngle(points[0], points[1], points[2]);
}

double distanceToUndefined(const SolidAngleSpring&, const std::array<Vector3, 3>& points) {
  return std::sqrt(triangle(points[0], points[1], points[2]).squared_norm);
}

Condition<3> condition(const SolidAngleSpring& spring, const std::array<Vector3, 3>& points) {
  const auto& [a, b, c] = points;
  const Triangle t = triangle(a, b, c);
  if (t.squared_norm == 0) {
    return {conditionValue(spring, t), {Vector3::Zero(), Vector3::Zero(), Vector3::Zero()}};
  }
  const double alpha = 2 * t.triple_product / t.squared_norm;
  const double beta = 2 * t.denominator / t.squared_norm;
  return {conditionValue(spring, t),
          {a.cross(beta * crossOfUnits(b, c) - alpha * sumOfUnits(b, c)),
           b.cross(beta * crossOfUnits(c, a) - alpha * sumOfUnits(c, a)),
           c.cross(beta * crossOfUnits(a, b) - alpha * sumOfUnits(a, b))}};
}

// With z = denominator + i triple_product, the angle is 2 arg z; u and v are the real and imaginary
// part of (grad z) / z, and the second derivatives follow by the product rule.
TangentCondition<3> tangentCondition(const SolidAngleSpring& spring,
                                     const std::array<Vector3, 3>& points,
                                     const std::array<TangentFrame, 3>& frames,
                                     Curvature curvature) {
  const Triangle t = triangle(points[0], points[1], points[2]);
  TangentCondition<3> result;
  result.value = conditionValue(spring, t);
  for (auto& row : result.hessian) row.fill(Eigen::Matrix2d::Zero());
  if (t.squared_norm == 0) {
    result.gradient.fill(Eigen::Vector2d::Zero());
    return result;
  }
  const double alpha = t.triple_product / t.squared_norm;
  const double beta = t.denominator / t.squared_norm;
  std::array<Eigen::Vector2d, 3> u, v;
  for (int i = 0; i < 3; ++i) {
    const Vector3& next = points[(i + 1) % 3];
    const Vector3& last = points[(i + 2) % 3];
    const Vector3 cross = crossOfUnits(next, last);
    const Vector3 sum = sumOfUnits(next, last);
    u[i] = frames[i].transpose() * (beta * sum + alpha * cross);
    v[i] = frames[i].transpose() * (beta * cross - alpha * sum);
    result.gradient[i] = 2 * v[i];
  }
  if (curvature == Curvature::definite) return result;

  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const int k = (i + 2) % 3;
    const double radial = alpha * (1 + points[j].dot(points[k]));
    const Eigen::Matrix2d uv = u[i] * v[i].transpose();
    result.hessian[i][i] = -2 * (uv + uv.transpose() + radial * Eigen::Matrix2d::Identity());
    const Eigen::Matrix2d mixed = frames[i].transpose() *
                                  (beta * skew(points[k]) + alpha * Eigen::Matrix3d::Identity()) *
                                  frames[j];
    result.hessian[i][j] = -2 * (u[i] * v[j].transpose() + v[i] * u[j].transpose() + mixed);
    result.hessian[j][i] = result.hessian[i][j].transpose();
  }
  return result;
}

}  // namespace spherical_springs::core
