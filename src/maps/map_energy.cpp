#include "maps/map_energy.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <utility>

#include "base/parallel.h"
#include "geometry/curve_order.h"
#include "maps/coverage.h"
#include "spherical_springs/springs/solid_angle.h"

namespace spherical_springs::mesh {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::uint32_t kNone = ~0u;
constexpr std::size_t kSweepBlock = 16;  // vertices that one thread moves in turn

/// Numbers by the first and last of which each vertex's corners stand.
std::vector<std::uint32_t> firstCorners(const Faces& faces, std::size_t vertices) {
  std::vector<std::uint32_t> first(vertices + 1, 0);
  for (Eigen::Index c = 0; c < faces.size(); ++c) ++first[faces(c) + 1];
  for (std::size_t v = 0; v < vertices; ++v) first[v + 1] += first[v];
  return first;
}

/// Neighbours of the vertices before `free`, all of whose faces are there: the next corners of
/// those.
core::Graph meshGraph(const Faces& faces, std::int32_t free) {
  const auto forEachEdge = [&](const auto& body) {
    for (Eigen::Index c = 0; c < faces.size(); ++c) {
      const std::int32_t v = faces(c), next = faces(c % 3 == 2 ? c - 2 : c + 1);
      if (v < free && next < free) body(v, static_cast<std::uint32_t>(next));
    }
  };
  core::Graph graph;
  graph.first.assign(free + 1, 0);
  forEachEdge([&](std::int32_t v, std::uint32_t) { ++graph.first[v + 1]; });
  for (std::int32_t v = 0; v < free; ++v) graph.first[v + 1] += graph.first[v] + 1;
  graph.neighbours.resize(graph.first.back());
  std::vector<std::uint32_t> place(graph.first.begin(), graph.first.end() - 1);
  for (std::int32_t v = 0; v < free; ++v) {
    graph.neighbours[place[v]++] = static_cast<std::uint32_t>(v);
  }
  forEachEdge([&](std::int32_t v, std::uint32_t next) { graph.neighbours[place[v]++] = next; });
  return graph;
}

/// The vertices before `free` in an order that is local, and then the others.
std::vector<std::uint32_t> freeFirst(const Points& points, std::int32_t free) {
  std::vector<std::uint32_t> order = core::curveOrder(points.leftCols(free));
  for (auto v = static_cast<std::uint32_t>(free); v < points.cols(); ++v) order.push_back(v);
  return order;
}

}  // namespace

MapEnergy::MapEnergy(const Faces& faces, const Eigen::VectorXd& shares, const Points& points,
                     int threads, const core::Checkpoint& checkpoint)
    : MapEnergy(faces, shares, points, static_cast<std::int32_t>(points.cols()), threads,
                checkpoint) {
  area_ = 4 * core::kPi;
}

MapEnergy::MapEnergy(const Faces& faces, const Eigen::VectorXd& shares, const Points& points,
                     std::int32_t free, int threads, const core::Checkpoint& checkpoint)
    : threads_(threads),
      checkpoint_(checkpoint),
      free_(free),
      vertices_(freeFirst(points, free)),
      faces_(faces),
      shares_(shares) {
  const std::size_t count = vertices_.size();
  std::vector<std::int32_t> numbers(count);
  for (std::size_t n = 0; n < count; ++n) numbers[vertices_[n]] = static_cast<std::int32_t>(n);
  for (Eigen::Index c = 0; c < faces.size(); ++c) faces_(c) = numbers[faces(c)];

  first_corner_ = firstCorners(faces_, count);
  checkpoint_();
  pattern_ = core::BlockPattern(meshGraph(faces_, free), threads);
  checkpoint_();
  corners_.resize(faces_.size());
  places_.resize(faces_.size(), {kNone, kNone, kNone});
  std::vector<std::uint32_t> next(first_corner_.begin(), first_corner_.end() - 1);
  for (Eigen::Index c = 0; c < faces_.size(); ++c) {
    const std::int32_t v = faces_(c);
    const std::uint32_t slot = next[v]++;
    corners_[slot] = static_cast<std::uint32_t>(c);
    for (int k = 0; k < 3; ++k) {
      const std::int32_t other = faces_(k, c / 3);
      if (v < free && other < free) places_[slot][k] = pattern_.place(v, other);
    }
  }
  terms_.resize(faces_.cols());
  gradient_.resize(2 * static_cast<Eigen::Index>(free));
  hessian_.resize(pattern_.graph.neighbours.size());
  checkpoint_();
  order_ = core::blockOrder(pattern_.graph, kSweepBlock, threads);
  setWeights(FaceWeights::equal);
  place(points);
  area_ = areas(points_).sum();
}

void MapEnergy::setWeights(FaceWeights weights) {
  weights_.setOnes(faceCount());
  if (weights == FaceWeights::root_of_share) weights_ = (shares_ / shares_.mean()).cwiseSqrt();
  mass_.setZero(static_cast<Eigen::Index>(vertices_.size()));
  for (Eigen::Index c = 0; c < faces_.size(); ++c) {
    mass_[faces_(c)] += weights_[c / 3] / shares_[c / 3];
  }
}

void MapEnergy::place(const Points& points) {
  std::vector<Vector3> in_order(vertices_.size());
  for (std::size_t n = 0; n < vertices_.size(); ++n) in_order[n] = points.col(vertices_[n]);
  put(std::move(in_order));
}

void MapEnergy::put(std::vector<Vector3> points) {
  points_ = std::move(points);
  frames_.resize(points_.size());
  core::parallelFor(points_.size(), threads_,
                    [&](std::ptrdiff_t n) { frames_[n] = core::tangentFrame(points_[n]); });
}

Points MapEnergy::points() const {
  Points result(3, static_cast<Eigen::Index>(vertices_.size()));
  writePoints(result);
  return result;
}

void MapEnergy::writePoints(Points& points) const {
  for (std::size_t n = 0; n < vertices_.size(); ++n) points.col(vertices_[n]) = points_[n];
}

std::vector<Vector3> MapEnergy::moved(const Eigen::VectorXd& step) const {
  std::vector<Vector3> result = points_;
  core::parallelFor(free_, threads_, [&](std::ptrdiff_t n) {
    result[n] = (points_[n] + frames_[n] * step.segment<2>(2 * n)).normalized();
  });
  return result;
}

double MapEnergy::valueAfter(const Eigen::VectorXd& step) const { return valueAt(moved(step)); }

void MapEnergy::move(const Eigen::VectorXd& step) { put(moved(step)); }

double MapEnergy::valueAt(const std::vector<Vector3>& points) const {
  const Eigen::ArrayXd areas = this->areas(points);
  if (!(std::abs(areas.sum() - area_) < 1)) return kInfinity;
  return core::parallelSum(faceCount(), threads_, [&](std::ptrdiff_t f) {
    return faceEnergy(f).value({points[faces_(0, f)], points[faces_(1, f)], points[faces_(2, f)]},
                               areas[f]);
  });
}

Eigen::ArrayXd MapEnergy::areas(const std::vector<Vector3>& points) const {
  Eigen::ArrayXd result(faceCount());
  core::parallelFor(faceCount(), threads_, [&](std::ptrdiff_t f) {
    result[f] = core::solidAngle(points[faces_(0, f)], points[faces_(1, f)], points[faces_(2, f)]);
  });
  return result;
}

FaceEnergy::Corners MapEnergy::corners(Eigen::Index face) const {
  return {points_[faces_(0, face)], points_[faces_(1, face)], points_[faces_(2, face)]};
}

FaceEnergy::Terms MapEnergy::terms(Eigen::Index face, FaceHessian hessian) const {
  const FaceEnergy::Frames frames = {frames_[faces_(0, face)], frames_[faces_(1, face)],
                                     frames_[faces_(2, face)]};
  return faceEnergy(face).terms(corners(face), frames, hessian);
}

void MapEnergy::evaluate(FaceHessian hessian) {
  constexpr std::ptrdiff_t kBetweenChecks = 256;  // faces or vertices
  value_ = core::parallelSum(faceCount(), threads_, [&](std::ptrdiff_t f) {
    if (f % kBetweenChecks == 0) checkpoint_();
    terms_[f] = terms(f, hessian);
    return terms_[f].value;
  });
  core::parallelFor(pattern_.rows(), threads_, [&](std::ptrdiff_t n) {
    if (n % kBetweenChecks == 0) checkpoint_();
    const core::Graph& graph = pattern_.graph;
    for (std::uint32_t e = graph.first[n]; e < graph.first[n + 1]; ++e) hessian_[e].setZero();
    gradient_.segment<2>(2 * n).setZero();
    for (std::uint32_t s = first_corner_[n]; s < first_corner_[n + 1]; ++s) {
      const FaceEnergy::Terms& terms = terms_[corners_[s] / 3];
      const int i = static_cast<int>(corners_[s] % 3);
      gradient_.segment<2>(2 * n) += terms.gradient.segment<2>(2 * i);
      for (int j = 0; j < 3; ++j) {
        if (places_[s][j] == kNone) continue;  // of a vertex that stays
        hessian_[places_[s][j]] += terms.hessian.block<2, 2>(2 * i, 2 * j);
      }
    }
  });
}

double MapEnergy::spread() const {
  const Eigen::ArrayXd logs = (areas(points_) / shares_.array()).log();
  return std::sqrt((logs - logs.mean()).square().mean());
}

/// Newton's step of one vertex, uphill directions of curvature turned round.
Eigen::Vector2d MapEnergy::ownStep(std::size_t n) const {
  constexpr double kLeastCurvature = 1e-6;  // of the other direction's
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
  Eigen::Matrix2d hessian = Eigen::Matrix2d::Zero();
  for (std::uint32_t s = first_corner_[n]; s < first_corner_[n + 1]; ++s) {
    const FaceEnergy::Terms of_face = terms(corners_[s] / 3, FaceHessian::exact);
    const int i = 2 * static_cast<int>(corners_[s] % 3);
    gradient += of_face.gradient.segment<2>(i);
    hessian += of_face.hessian.block<2, 2>(i, i);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(hessian);
  const Eigen::Array2d curvature = axes.eigenvalues().array().abs();
  const Eigen::Array2d bounded = curvature.max(kLeastCurvature * curvature.maxCoeff());
  return -axes.eigenvectors() *
         ((axes.eigenvectors().transpose() * gradient).array() / bounded).matrix();
}

/// Energy of the faces round a vertex if it were at `point`.
double MapEnergy::ownValue(std::size_t n, const Vector3& point) const {
  double sum = 0;
  for (std::uint32_t s = first_corner_[n]; s < first_corner_[n + 1]; ++s) {
    FaceEnergy::Corners around = corners(corners_[s] / 3);
    around[corners_[s] % 3] = point;
    sum += faceEnergy(corners_[s] / 3).value(around);
  }
  return sum;
}

void MapEnergy::moveAlone(std::size_t n) {
  constexpr int kMostCuts = 12;
  Eigen::Vector2d step = ownStep(n);
  const double before = ownValue(n, points_[n]);
  for (int cut = 0; cut < kMostCuts; ++cut, step /= 2) {
    const Vector3 point = (points_[n] + frames_[n] * step).normalized();
    if (!(ownValue(n, point) < before)) continue;
    points_[n] = point;
    frames_[n] = core::tangentFrame(point);
    return;
  }
}

void MapEnergy::moveEachAlone() {
  order_.apart.forEach(threads_, [&](std::uint32_t block) {
    checkpoint_();
    for (std::uint32_t n = order_.first_node[block]; n < order_.first_node[block + 1]; ++n) {
      moveAlone(n);
    }
  });
}

void MapEnergy::sweep() {
  std::vector<Vector3> before = points_;
  try {
    moveEachAlone();
    if (valueAt(points_) < kInfinity) return;
  } catch (...) {
    put(std::move(before));
    throw;
  }
  put(std::move(before));  // positive faces round a vertex alone may cover a part twice
}

}  // namespace spherical_springs::mesh
