#include "map_energy.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

#include "../curve_order.h"
#include "../parallel.h"
#include "coverage.h"
#include "spherical_springs/springs/solid_angle_spring.h"

namespace spherical_springs::mesh {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A function of the area and of the corners' distances with its derivatives.
struct Barrier {
  double value, slope, bend;
};

/// (r + 1/r - 2) / 2 of r = area / share, by the area.
Barrier areaBarrier(double area, double share) {
  const double r = area / share;
  return {0.5 * (r - 1) * (r - 1) / r, 0.5 * (1 - 1 / (r * r)) / share,
          1 / (r * r * r) / (share * share)};
}

/// tan^2(area / 4), by the area.
Barrier halfSphereBarrier(double area) {
  const double t = std::tan(area / 4), t2 = t * t;
  return {t2, 0.5 * t * (1 + t2), (1 + t2) * (1 + 3 * t2) / 8};
}

/// tan^2(edge / 2) / sqrt 3, by the cosine of the edge.
Barrier edgeBarrier(const Vector3& a, const Vector3& b) {
  const double scale = 1 / std::sqrt(3.);
  const double sum = 0.5 * (a + b).squaredNorm();  // 1 + cosine
  return {scale * 0.5 * (a - b).squaredNorm() / sum, -2 * scale / (sum * sum),
          4 * scale / (sum * sum * sum)};
}

/// Numbers by the first and last of which each vertex's corners stand.
std::vector<std::uint32_t> firstCorners(const Faces& faces, std::size_t vertices) {
  std::vector<std::uint32_t> first(vertices + 1, 0);
  for (Eigen::Index c = 0; c < faces.size(); ++c) ++first[faces(c) + 1];
  for (std::size_t v = 0; v < vertices; ++v) first[v + 1] += first[v];
  return first;
}

/// A vertex of a closed mesh has as many neighbours as corners.
core::Graph meshGraph(const Faces& faces, const std::vector<std::uint32_t>& first_corner) {
  const std::size_t count = first_corner.size() - 1;
  core::Graph graph;
  graph.first.resize(count + 1);
  for (std::size_t v = 0; v <= count; ++v) {
    graph.first[v] = first_corner[v] + static_cast<std::uint32_t>(v);
  }
  graph.neighbours.resize(graph.first.back());
  std::vector<std::uint32_t> next(graph.first.begin(), graph.first.end() - 1);
  for (std::uint32_t v = 0; v < count; ++v) graph.neighbours[next[v]++] = v;
  for (Eigen::Index f = 0; f < faces.cols(); ++f) {
    for (int k = 0; k < 3; ++k) {
      graph.neighbours[next[faces(k, f)]++] = static_cast<std::uint32_t>(faces((k + 1) % 3, f));
    }
  }
  return graph;
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

MapEnergy::MapEnergy(const Faces& faces, const Eigen::VectorXd& shares, const Points& points,
                     int threads)
    : threads_(threads), vertices_(core::curveOrder(points)), faces_(faces), shares_(shares) {
  const std::size_t count = vertices_.size();
  std::vector<std::int32_t> numbers(count);
  for (std::size_t n = 0; n < count; ++n) numbers[vertices_[n]] = static_cast<std::int32_t>(n);
  for (Eigen::Index c = 0; c < faces.size(); ++c) faces_(c) = numbers[faces(c)];

  first_corner_ = firstCorners(faces_, count);
  pattern_ = core::BlockPattern(meshGraph(faces_, first_corner_), threads);
  corners_.resize(faces_.size());
  places_.resize(faces_.size());
  mass_.setZero(static_cast<Eigen::Index>(count));
  std::vector<std::uint32_t> next(first_corner_.begin(), first_corner_.end() - 1);
  for (Eigen::Index c = 0; c < faces_.size(); ++c) {
    const std::int32_t v = faces_(c);
    const std::uint32_t slot = next[v]++;
    corners_[slot] = static_cast<std::uint32_t>(c);
    for (int k = 0; k < 3; ++k) places_[slot][k] = pattern_.place(v, faces_(k, c / 3));
    mass_[v] += 1 / shares_[c / 3];
  }
  terms_.resize(faces_.cols());
  gradient_.resize(static_cast<Eigen::Index>(2 * count));
  hessian_.resize(pattern_.graph.neighbours.size());
  place(points);
}

void MapEnergy::place(const Points& points) {
  points_.resize(vertices_.size());
  frames_.resize(vertices_.size());
  for (std::size_t n = 0; n < vertices_.size(); ++n) {
    points_[n] = points.col(vertices_[n]);
    frames_[n] = core::tangentFrame(points_[n]);
  }
}

Points MapEnergy::points() const {
  Points result(3, static_cast<Eigen::Index>(vertices_.size()));
  for (std::size_t n = 0; n < vertices_.size(); ++n) result.col(vertices_[n]) = points_[n];
  return result;
}

std::vector<Vector3> MapEnergy::moved(const Eigen::VectorXd& step) const {
  std::vector<Vector3> result(points_.size());
  core::parallelFor(points_.size(), threads_, [&](std::ptrdiff_t n) {
    result[n] = (points_[n] + frames_[n] * step.segment<2>(2 * n)).normalized();
  });
  return result;
}

double MapEnergy::valueAfter(const Eigen::VectorXd& step) const { return valueAt(moved(step)); }

void MapEnergy::move(const Eigen::VectorXd& step) {
  points_ = moved(step);
  core::parallelFor(points_.size(), threads_,
                    [&](std::ptrdiff_t n) { frames_[n] = core::tangentFrame(points_[n]); });
}

double MapEnergy::valueAt(const std::vector<Vector3>& points) const {
  Eigen::VectorXd areas(faceCount());
  const double value = core::parallelSum(faceCount(), threads_, [&](std::ptrdiff_t f) {
    const Vector3 &a = points[faces_(0, f)], &b = points[faces_(1, f)], &c = points[faces_(2, f)];
    areas[f] = 0;
    if (!surelyPositive(a, b, c)) return kInfinity;
    areas[f] = core::solidAngle(a, b, c);
    double sum = areaBarrier(areas[f], shares_[f]).value;
    if (shape_ > 0) {
      sum += shape_ / shares_[f] *
             (halfSphereBarrier(areas[f]).value + edgeBarrier(a, b).value +
              edgeBarrier(b, c).value + edgeBarrier(c, a).value);
    }
    return sum;
  });
  return std::abs(areas.sum() - 4 * core::kPi) < 1 ? value : kInfinity;
}

MapEnergy::FaceTerms MapEnergy::termsOf(Eigen::Index face, FaceHessian hessian) const {
  std::array<Vector3, 3> points;
  std::array<core::TangentFrame, 3> frames;
  for (int k = 0; k < 3; ++k) {
    points[k] = points_[faces_(k, face)];
    frames[k] = frames_[faces_(k, face)];
  }
  const auto area =
      core::tangentCondition(core::SolidAngleSpring(), points, frames, core::Curvature::exact);
  Barrier of_area = areaBarrier(area.value, shares_[face]);
  if (shape_ > 0) {
    const Barrier half_sphere = halfSphereBarrier(area.value);
    const double weight = shape_ / shares_[face];
    of_area.value += weight * half_sphere.value;
    of_area.slope += weight * half_sphere.slope;
    of_area.bend += weight * half_sphere.bend;
  }
  const double area_slope = hessian == FaceHessian::gauss_newton ? 0 : of_area.slope;
  FaceTerms terms;
  terms.value = of_area.value;
  Vector6 area_gradient;
  for (int i = 0; i < 3; ++i) {
    area_gradient.segment<2>(2 * i) = area.gradient[i];
    for (int j = 0; j < 3; ++j) {
      terms.hessian.block<2, 2>(2 * i, 2 * j) = area_slope * area.hessian[i][j];
    }
  }
  terms.gradient = of_area.slope * area_gradient;
  terms.hessian += of_area.bend * area_gradient * area_gradient.transpose();
  if (shape_ > 0) {
    const double weight = shape_ / shares_[face];
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      const Barrier of_edge = edgeBarrier(points[i], points[j]);
      const Eigen::Vector2d g_i = frames[i].transpose() * points[j];
      const Eigen::Vector2d g_j = frames[j].transpose() * points[i];
      const double slope = weight * of_edge.slope, bend = weight * of_edge.bend;
      const double radial = slope * points[i].dot(points[j]);
      const Eigen::Matrix2d mixed =
          bend * g_i * g_j.transpose() + slope * frames[i].transpose() * frames[j];
      terms.value += weight * of_edge.value;
      terms.gradient.segment<2>(2 * i) += slope * g_i;
      terms.gradient.segment<2>(2 * j) += slope * g_j;
      terms.hessian.block<2, 2>(2 * i, 2 * i) +=
          bend * g_i * g_i.transpose() - radial * Eigen::Matrix2d::Identity();
      terms.hessian.block<2, 2>(2 * j, 2 * j) +=
          bend * g_j * g_j.transpose() - radial * Eigen::Matrix2d::Identity();
      terms.hessian.block<2, 2>(2 * i, 2 * j) += mixed;
      terms.hessian.block<2, 2>(2 * j, 2 * i) += mixed.transpose();
    }
  }
  if (hessian == FaceHessian::definite) makeDefinite(terms.hessian);
  return terms;
}

void MapEnergy::evaluate(FaceHessian hessian) {
  value_ = core::parallelSum(faceCount(), threads_, [&](std::ptrdiff_t f) {
    terms_[f] = termsOf(f, hessian);
    return terms_[f].value;
  });
  core::parallelFor(pattern_.rows(), threads_, [&](std::ptrdiff_t n) {
    const core::Graph& graph = pattern_.graph;
    for (std::uint32_t e = graph.first[n]; e < graph.first[n + 1]; ++e) hessian_[e].setZero();
    gradient_.segment<2>(2 * n).setZero();
    for (std::uint32_t s = first_corner_[n]; s < first_corner_[n + 1]; ++s) {
      const FaceTerms& terms = terms_[corners_[s] / 3];
      const int i = static_cast<int>(corners_[s] % 3);
      gradient_.segment<2>(2 * n) += terms.gradient.segment<2>(2 * i);
      for (int j = 0; j < 3; ++j) {
        hessian_[places_[s][j]] += terms.hessian.block<2, 2>(2 * i, 2 * j);
      }
    }
  });
}

double MapEnergy::spread() const {
  Eigen::ArrayXd logs(faceCount());
  core::parallelFor(faceCount(), threads_, [&](std::ptrdiff_t f) {
    logs[f] = std::log(
        core::solidAngle(points_[faces_(0, f)], points_[faces_(1, f)], points_[faces_(2, f)]) /
        shares_[f]);
  });
  return std::sqrt((logs - logs.mean()).square().mean());
}

}  // namespace spherical_springs::mesh
