#include "spherical_springs/springs/angle.h"

#include <algorithm>
#include <cmath>

namespace spherical_springs::core {

void rest(AngleSpring& spring, const std::array<Vector3, 2>& points) {
  spring.rest_angle = arc(points[0], points[1]).angle;
}

Condition<2> condition(const AngleSpring& spring, const std::array<Vector3, 2>& points) {
  const Arc between = arc(points[0], points[1]);
  return {between.angle - spring.rest_angle, {-between.axis, between.axis}};
}

// The Hessian of the angle acts across the arc only. Its eigenvectors there are both ends moving to
// the same side, with -tan(angle / 2), and to opposite sides, with cot(angle / 2).
TangentCondition<2> tangentCondition(const AngleSpring& spring,
                                     const std::array<Vector3, 2>& points,
                                     const std::array<TangentFrame, 2>& frames,
                                     Curvature curvature) {
  constexpr double kNearestToSingular = 1e-12;
  const Arc between = arc(points[0], points[1]);
  const double angle = std::clamp(between.angle, kNearestToSingular, kPi - kNearestToSingular);
  TangentCondition<2> result;
  result.value = angle - spring.rest_angle;
  result.gradient[0] = frames[0].transpose() * points[0].cross(between.axis);
  result.gradient[1] = frames[1].transpose() * between.axis.cross(points[1]);

  double same_side = -std::tan(angle / 2);
  double opposite_sides = 1 / std::tan(angle / 2);
  const double least = leastCurvature(curvature);
  if (result.value * same_side < least) same_side = 0;
  if (result.value * opposite_sides < least) opposite_sides = 0;
  const std::array<Eigen::Vector2d, 2> across = {
      Eigen::Vector2d(result.gradient[0].y(), -result.gradient[0].x()),
      Eigen::Vector2d(-result.gradient[1].y(), result.gradient[1].x())};
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      const double weight = (same_side + (i == j ? opposite_sides : -opposite_sides)) / 2;
      result.hessian[i][j] = weight * across[i] * across[j].transpose();
    }
  }
  return result;
}

}  // namespace spherical_springs::core
