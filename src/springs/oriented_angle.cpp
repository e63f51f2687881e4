#include "spherical_springs/springs/oriented_angle.h"

#include <cmath>

#include "spherical_springs/springs/angle.h"
#include "springs/skew.h"

namespace spherical_springs::core {
namespace {

double defaultWidth(double angle) {
  const double sine = std::sin(angle / 2);
  return 0.2 * sine * sine;
}

/// The odd, twice differentiable step from -1 to 1 over [-width, width], and its derivatives.
struct Sign {
  double value, slope, bend;
};

Sign sign(double triple_product, double width) {
  if (triple_product >= width) return {1, 0, 0};
  if (triple_product <= -width) return {-1, 0, 0};
  const double u = triple_product / width;
  const double u2 = u * u;
  return {u * (15 - 10 * u2 + 3 * u2 * u2) / 8, 15 * (1 - u2) * (1 - u2) / (8 * width),
          -15 * u * (1 - u2) / (2 * width * width)};
}

}  // namespace

double effectiveWidth(const OrientedAngleSpring& spring) {
  constexpr double kSharpest = 1e-12;
  const double width = spring.width > 0 ? spring.width : defaultWidth(spring.rest_angle);
  return width < kSharpest ? 0 : width;
}

void rest(OrientedAngleSpring& spring, const std::array<Vector3, 3>& points) {
  const double angle = arc(points[0], points[1]).angle;
  if (spring.width == 0) spring.width = defaultWidth(angle);
  const double alpha = tripleProduct(points[0], points[1], points[2]);
  spring.rest_angle = sign(alpha, effectiveWidth(spring)).value * angle;
}

bool isFlat(const OrientedAngleSpring& spring, const std::array<Vector3, 3>& points) {
  constexpr double kFlat = 1e-3;    // [rad]; further away the torque shows
  constexpr double kAtRest = 1e-3;  // of the angle at rest; little energy is left there
  if (!((points[1] - points[0]).norm() < kFlat)) return false;
  return std::abs(condition(spring, points).value) > kAtRest * std::abs(spring.rest_angle);
}

Condition<3> condition(const OrientedAngleSpring& spring, const std::array<Vector3, 3>& points) {
  const auto& [a, b, c] = points;
  const Arc between = arc(a, b);
  const Sign s = sign(tripleProduct(a, b, c), effectiveWidth(spring));
  Condition<3> result{s.value * between.angle - spring.rest_angle,
                      {-s.value * between.axis, s.value * between.axis, Vector3::Zero()}};
  if (s.slope != 0) {
    const double turn = s.slope * between.angle;
    result.gradient[0] += turn * a.cross(crossOfUnits(b, c));
    result.gradient[1] += turn * b.cross(crossOfUnits(c, a));
    result.gradient[2] += turn * c.cross(crossOfUnits(a, b));
  }
  return result;
}

// C = sign(alpha) theta - rest, so by the product rule, with f = theta and s = sign:
// hess C = s hess f + f (s' hess alpha + s'' grad alpha grad alpha^T)
//          + s' (grad alpha grad f^T + grad f grad alpha^T).
TangentCondition<3> tangentCondition(const OrientedAngleSpring& spring,
                                     const std::array<Vector3, 3>& points,
                                     const std::array<TangentFrame, 3>& frames,
                                     Curvature curvature) {
  const double alpha = tripleProduct(points[0], points[1], points[2]);
  const Sign s = sign(alpha, effectiveWidth(spring));
  const double angle = arc(points[0], points[1]).angle;
  TangentCondition<3> result;
  result.value = s.value * angle - spring.rest_angle;

  // The arc under a definite curvature must see the sign of its share, value * s.value.
  AngleSpring plain;
  plain.rest_angle = angle - s.value * result.value;
  const TangentCondition<2> theta =
      tangentCondition(plain, {points[0], points[1]}, {frames[0], frames[1]}, curvature);
  std::array<Eigen::Vector2d, 3> grad_alpha;
  for (int i = 0; i < 3; ++i) {
    grad_alpha[i] = frames[i].transpose() * crossOfUnits(points[(i + 1) % 3], points[(i + 2) % 3]);
    result.gradient[i] = s.slope * angle * grad_alpha[i];
  }
  for (auto& row : result.hessian) row.fill(Eigen::Matrix2d::Zero());
  for (int i = 0; i < 2; ++i) {
    result.gradient[i] += s.value * theta.gradient[i];
    for (int j = 0; j < 2; ++j) result.hessian[i][j] = s.value * theta.hessian[i][j];
  }
  if (curvature == Curvature::definite || s.slope == 0) return result;

  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      result.hessian[i][j] += s.bend * angle * grad_alpha[i] * grad_alpha[j].transpose();
      if (i < 2) result.hessian[i][j] += s.slope * theta.gradient[i] * grad_alpha[j].transpose();
      if (j < 2) result.hessian[i][j] += s.slope * grad_alpha[i] * theta.gradient[j].transpose();
    }
    result.hessian[i][i] -= s.slope * angle * alpha * Eigen::Matrix2d::Identity();
    const int j = (i + 1) % 3;
    const Eigen::Matrix2d mixed =
        s.slope * angle * (frames[i].transpose() * skew(points[(i + 2) % 3]) * frames[j]);
    result.hessian[i][j] -= mixed;
    result.hessian[j][i] -= mixed.transpose();
  }
  return result;
}

}  // namespace spherical_springs::core
