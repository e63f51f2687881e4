#include "maps/map_energy.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/parallel.h"

namespace spherical_springs::mesh {
namespace {

using BlockMap = Eigen::Map<Eigen::Matrix2d>;
using ConstBlockMap = Eigen::Map<const Eigen::Matrix2d>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::ptrdiff_t kFaceBlock = 256;  // faces that one thread evaluates in turn

template <class Body>
void forBlocks(std::ptrdiff_t count, int threads, const Body& body) {
  core::forOnThreads((count + kFaceBlock - 1) / kFaceBlock, core::worthwhileThreads(count, threads),
                     [&](std::ptrdiff_t block) {
                       const std::ptrdiff_t begin = block * kFaceBlock;
                       const std::ptrdiff_t end = std::min(count, begin + kFaceBlock);
                       body(block, static_cast<std::uint32_t>(begin),
                            static_cast<std::uint32_t>(end));
                     });
}

/// Room for the faces that kernels leave out of a block.
struct Rest {
  std::uint32_t faces[kFaceBlock];
  LeftOut list = {faces, 0};

  template <class Body>
  void forEach(const Body& body) const {
    for (std::uint32_t i = 0; i < list.count; ++i) body(static_cast<Eigen::Index>(faces[i]));
  }
};

}  // namespace

FaceLists MapEnergy::faceLists() const {
  return {faces_.data(), over_shares_.data(), weights_.data(), shape_, cost_};
}

void MapEnergy::place(const Points& points) {
  places_.resize(vertices_.size());
  core::parallelFor(static_cast<std::ptrdiff_t>(places_.size()), threads_, [&](std::ptrdiff_t n) {
    const Vector3 point = points.col(vertices_[n]);
    places_[n] = {core::tangentFrame(point), point};
  });
}

Points MapEnergy::points() const {
  Points result(3, static_cast<Eigen::Index>(vertices_.size()));
  writePoints(result);
  return result;
}

void MapEnergy::writePoints(Points& points) const {
  for (std::size_t n = 0; n < vertices_.size(); ++n) points.col(vertices_[n]) = places_[n].point;
}

Vector3 MapEnergy::moved(std::size_t n, const Eigen::VectorXd& step) const {
  const auto& [frame, point] = places_[n];
  return (point + frame * step.segment<2>(2 * static_cast<Eigen::Index>(n))).normalized();
}

double MapEnergy::valueAfter(const Eigen::VectorXd& step) {
  core::parallelFor(static_cast<std::ptrdiff_t>(places_.size()), threads_, [&](std::ptrdiff_t n) {
    trial_[n].point = n < free_ ? moved(n, step) : places_[n].point;
  });
  return valueAt({trial_.front().point.data(), sizeof(PaddedPoint) / sizeof(double)});
}

void MapEnergy::move(const Eigen::VectorXd& step) {
  core::parallelFor(free_, threads_, [&](std::ptrdiff_t n) {
    const Vector3 point = moved(n, step);
    places_[n] = {core::tangentFrame(point), point};
  });
}

double MapEnergy::valueAt(const PointRows& points) const {
  std::vector<FaceSums> sums((faceCount() + kFaceBlock - 1) / kFaceBlock);
  const FaceLists lists = faceLists();
  forBlocks(faceCount(), threads_, [&](std::ptrdiff_t block, auto begin, auto end) {
    Rest rest;
    FaceSums& sum = sums[block] = kernels_.sums(lists, points, begin, end, rest.list);
    rest.forEach([&](Eigen::Index f) {
      const auto at = corners(f, points);
      const double area = core::solidAngle(at[0], at[1], at[2]);
      sum.area += area;
      sum.energy += faceEnergy(f).value(at, area);
    });
  });
  FaceSums all = {};
  for (const FaceSums& sum : sums) all = {all.energy + sum.energy, all.area + sum.area};
  return std::abs(all.area - area_) < 1 ? all.energy : kInfinity;
}

Eigen::ArrayXd MapEnergy::areas() const {
  Eigen::ArrayXd result(faceCount());
  const FaceLists lists = faceLists();
  const PointRows points = rowsHere();
  forBlocks(faceCount(), threads_, [&](std::ptrdiff_t, auto begin, auto end) {
    Rest rest;
    kernels_.areas(lists, points, begin, end, result.data(), rest.list);
    rest.forEach([&](Eigen::Index f) {
      const auto at = corners(f, points);
      result[f] = core::solidAngle(at[0], at[1], at[2]);
    });
  });
  return result;
}

FaceEnergy::Corners MapEnergy::corners(Eigen::Index face, const PointRows& points) const {
  const auto corner = [&](int k) -> Vector3 {
    return Eigen::Map<const Vector3>(points.first + points.stride * faces_(k, face));
  };
  return {corner(0), corner(1), corner(2)};
}

FaceEnergy::Terms MapEnergy::terms(Eigen::Index face, FaceHessian hessian) const {
  const auto frame = [&](int k) { return places_[faces_(k, face)].frame; };
  return faceEnergy(face).terms(corners(face, rowsHere()), {frame(0), frame(1), frame(2)}, hessian);
}

double MapEnergy::evaluateFaces(std::uint32_t begin, std::uint32_t end, FaceHessian hessian) {
  Rest rest;
  double value = kernels_.terms(faceLists(), places_.front().frame.data(), begin, end, hessian,
                                terms_.data(), rest.list);
  rest.forEach([&](Eigen::Index f) {
    const FaceEnergy::Terms of_face = terms(f, hessian);
    value += of_face.value;
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      Eigen::Map<Eigen::Vector2d>(terms_[f].gradient[i]) = of_face.gradient.segment<2>(2 * i);
      BlockMap(terms_[f].diagonal[i]) = of_face.hessian.block<2, 2>(2 * i, 2 * i);
      BlockMap(terms_[f].coupling[i]) = of_face.hessian.block<2, 2>(2 * i, 2 * j);
    }
  });
  return value;
}

/// Gradient and Hessian of a vertex from the faces round it.
void MapEnergy::gatherRow(std::size_t n) {
  const core::Graph& graph = pattern_.graph;
  for (std::uint32_t e = graph.first[n]; e < graph.first[n + 1]; ++e) hessian_[e].setZero();
  auto gradient = gradient_.segment<2>(2 * static_cast<Eigen::Index>(n));
  gradient.setZero();
  for (std::uint32_t s = first_corner_[n]; s < first_corner_[n + 1]; ++s) {
    const FaceTerms& terms = terms_[corners_[s] / 3];
    const std::uint32_t i = corners_[s] % 3, next = (i + 1) % 3, last = (i + 2) % 3;
    gradient += Eigen::Map<const Eigen::Vector2d>(terms.gradient[i]);
    hessian_[blocks_[s][i]] += ConstBlockMap(terms.diagonal[i]);
    // Others stay, and have no block.
    if (blocks_[s][next] != kNoBlock)
      hessian_[blocks_[s][next]] += ConstBlockMap(terms.coupling[i]);
    if (blocks_[s][last] != kNoBlock) {
      hessian_[blocks_[s][last]] += ConstBlockMap(terms.coupling[last]).transpose();
    }
  }
}

void MapEnergy::evaluate(FaceHessian hessian) {
  std::vector<double> values((faceCount() + kFaceBlock - 1) / kFaceBlock);
  forBlocks(faceCount(), threads_, [&](std::ptrdiff_t block, auto begin, auto end) {
    checkpoint_();
    values[block] = evaluateFaces(begin, end, hessian);
  });
  value_ = std::accumulate(values.begin(), values.end(), 0.);
  forBlocks(static_cast<std::ptrdiff_t>(pattern_.rows()), threads_,
            [&](std::ptrdiff_t, auto begin, auto end) {
              checkpoint_();
              for (std::size_t n = begin; n < end; ++n) gatherRow(n);
            });
}

double MapEnergy::spread() const {
  const Eigen::ArrayXd logs = (areas() / shares_.array()).log();
  return std::sqrt((logs - logs.mean()).square().mean());
}

}  // namespace spherical_springs::mesh
