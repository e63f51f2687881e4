#include "maps/face_energy.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

#include "maps/coverage.h"
#include "spherical_springs/springs/solid_angle.h"

namespace spherical_springs::mesh {
namespace {

/// A function of the area and of the corners' distances with its derivatives.
struct Cost {
  double value, slope, bend;
};

/// Returns the cost and its derivatives by the area.
Cost areaCost(AreaCost cost, double area, double share) {
  const double r = area / share;
  if (cost == AreaCost::square) {
    return {0.5 * (r - 1) * (r - 1), (r - 1) / share, 1 / (share * share)};
  }
  return {0.5 * (r - 1) * (r - 1) / r, 0.5 * (1 - 1 / (r * r)) / share,
          1 / (r * r * r) / (share * share)};
}

/// tan^2(area / 4), by the area.
Cost halfSphereCost(double area) {
  const double t = std::tan(area / 4), t2 = t * t;
  return {t2, 0.5 * t * (1 + t2), (1 + t2) * (1 + 3 * t2) / 8};
}

/// tan^2(edge / 2) / sqrt 3, by the cosine of the edge.
Cost edgeCost(const Vector3& a, const Vector3& b) {
  const double scale = 1 / std::sqrt(3.);
  const double sum = 0.5 * (a + b).squaredNorm();  // 1 + cosine
  return {scale * 0.5 * (a - b).squaredNorm() / sum, -2 * scale / (sum * sum),
          4 * scale / (sum * sum * sum)};
}

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

void makeDefinite(Matrix6& matrix) {
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(matrix);
  if (solver.eigenvalues()[0] >= 0) return;
  const Vector6 kept = solver.eigenvalues().cwiseMax(0);
  matrix = solver.eigenvectors() * kept.asDiagonal() * solver.eigenvectors().transpose();
}

}  // namespace

double FaceEnergy::value(const Corners& corners, double area) const {
  const auto& [a, b, c] = corners;
  if (cost == AreaCost::barrier && !surelyPositive(a, b, c)) {
    return std::numeric_limits<double>::infinity();
  }
  double sum = areaCost(cost, area, share).value;
  if (shape > 0) {
    sum += shape / share *
           (halfSphereCost(area).value + edgeCost(a, b).value + edgeCost(b, c).value +
            edgeCost(c, a).value);
  }
  return weight * sum;
}

FaceEnergy::Terms FaceEnergy::terms(const Corners& corners, const Frames& frames,
                                    FaceHessian hessian) const {
  const auto curvature =
      hessian == FaceHessian::gauss_newton ? core::Curvature::definite : core::Curvature::exact;
  const auto area = core::tangentCondition(core::SolidAngleSpring(), corners, frames, curvature);
  Cost of_area = areaCost(cost, area.value, share);
  if (shape > 0) {
    const Cost half_sphere = halfSphereCost(area.value);
    of_area.value += shape / share * half_sphere.value;
    of_area.slope += shape / share * half_sphere.slope;
    of_area.bend += shape / share * half_sphere.bend;
  }
  const double area_slope = weight * of_area.slope;
  Terms terms;
  terms.value = weight * of_area.value;
  Vector6 area_gradient;
  for (int i = 0; i < 3; ++i) {
    area_gradient.segment<2>(2 * i) = area.gradient[i];
    for (int j = 0; j < 3; ++j) {
      terms.hessian.block<2, 2>(2 * i, 2 * j) = area_slope * area.hessian[i][j];
    }
  }
  terms.gradient = weight * of_area.slope * area_gradient;
  terms.hessian += weight * of_area.bend * area_gradient * area_gradient.transpose();
  if (shape > 0) addEdges(corners, frames, terms);
  if (hessian == FaceHessian::definite) makeDefinite(terms.hessian);
  return terms;
}

void FaceEnergy::addEdges(const Corners& corners, const Frames& frames, Terms& terms) const {
  const double scale = weight * shape / share;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const Cost of_edge = edgeCost(corners[i], corners[j]);
    const Eigen::Vector2d g_i = frames[i].transpose() * corners[j];
    const Eigen::Vector2d g_j = frames[j].transpose() * corners[i];
    const double slope = scale * of_edge.slope, bend = scale * of_edge.bend;
    const Eigen::Matrix2d radial = slope * corners[i].dot(corners[j]) * Eigen::Matrix2d::Identity();
    const Eigen::Matrix2d mixed =
        bend * g_i * g_j.transpose() + slope * frames[i].transpose() * frames[j];
    terms.value += scale * of_edge.value;
    terms.gradient.segment<2>(2 * i) += slope * g_i;
    terms.gradient.segment<2>(2 * j) += slope * g_j;
    terms.hessian.block<2, 2>(2 * i, 2 * i) += bend * g_i * g_i.transpose() - radial;
    terms.hessian.block<2, 2>(2 * j, 2 * j) += bend * g_j * g_j.transpose() - radial;
    terms.hessian.block<2, 2>(2 * i, 2 * j) += mixed;
    terms.hessian.block<2, 2>(2 * j, 2 * i) += mixed.transpose();
  }
}

}  // namespace spherical_springs::mesh
