#include "maps/face_energy.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

#include "maps/coverage.h"
#include "maps/face_cost.h"
#include "spherical_springs/springs/solid_angle.h"

namespace spherical_springs::mesh {
namespace {

Cost<double> areaCost(AreaCost cost, double area, double share) {
  return cost == AreaCost::square ? squareCost(area, 1 / share) : barrierCost(area, 1 / share);
}

Cost<double> halfSphereCostOf(double area) { return halfSphereCost(std::tan(area / 4)); }

Cost<double> edgeCostOf(const Vector3& a, const Vector3& b) {
  return edgeCost((a - b).squaredNorm(), 2 / (a + b).squaredNorm());
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
           (halfSphereCostOf(area).value + edgeCostOf(a, b).value + edgeCostOf(b, c).value +
            edgeCostOf(c, a).value);
  }
  return weight * sum;
}

FaceEnergy::Terms FaceEnergy::terms(const Corners& corners, const Frames& frames,
                                    FaceHessian hessian) const {
  const auto curvature =
      hessian == FaceHessian::gauss_newton ? core::Curvature::definite : core::Curvature::exact;
  const auto area = core::tangentCondition(core::SolidAngleSpring(), corners, frames, curvature);
  Cost<double> of_area = areaCost(cost, area.value, share);
  if (shape > 0) {
    const Cost<double> half_sphere = halfSphereCostOf(area.value);
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
    const Cost<double> of_edge = edgeCostOf(corners[i], corners[j]);
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
