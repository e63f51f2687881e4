#include "maps/map_energy.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/parallel.h"
#include "geometry/curve_order.h"

namespace spherical_springs::mesh {
namespace {

using BlockMap = Eigen::Map<Eigen::Matrix2d>;
using ConstBlockMap = Eigen::Map<const Eigen::Matrix2d>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::uint32_t kNone = ~0u;
constexpr std::ptrdiff_t kFaceBlock = 256;  // faces that one thread evaluates in turn
constexpr std::size_t kSweepBlock = 16;     // vertices that one thread moves in turn

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

/// One a face, with what kernels may read after the last.
std::vector<double> padded(const Eigen::ArrayXd& values) {
  std::vector<double> result(values.size() + kLanePadding, 1);
  std::copy(values.begin(), values.end(), result.begin());
  return result;
}

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
  layOutCorners();
  terms_.resize(faces_.cols());
  gradient_.resize(2 * static_cast<Eigen::Index>(free));
  hessian_.resize(pattern_.graph.neighbours.size());
  checkpoint_();
  order_ = core::blockOrder(pattern_.graph, kSweepBlock, threads);
  over_shares_ = padded(shares_.cwiseInverse());
  setWeights(FaceWeights::equal);
  trial_.resize(count);
  place(points);
  area_ = areas().sum();
}

/// Faces round each vertex, and where their blocks are.
void MapEnergy::layOutCorners() {
  corners_.resize(faces_.size());
  blocks_.resize(faces_.size(), {kNone, kNone, kNone});
  next_.resize(faces_.size());
  last_.resize(faces_.size());
  std::vector<std::uint32_t> next(first_corner_.begin(), first_corner_.end() - 1);
  for (Eigen::Index c = 0; c < faces_.size(); ++c) {
    const std::int32_t v = faces_(c);
    const std::uint32_t slot = next[v]++;
    corners_[slot] = static_cast<std::uint32_t>(c);
    next_[slot] = faces_((c + 1) % 3, c / 3);
    last_[slot] = faces_((c + 2) % 3, c / 3);
    for (int k = 0; k < 3; ++k) {
      const std::int32_t other = faces_(k, c / 3);
      if (v < free_ && other < free_) blocks_[slot][k] = pattern_.place(v, other);
    }
  }
}

void MapEnergy::setWeights(FaceWeights weights) {
  Eigen::ArrayXd of_faces = Eigen::ArrayXd::Ones(faceCount());
  if (weights == FaceWeights::root_of_share) of_faces = (shares_ / shares_.mean()).cwiseSqrt();
  weights_ = padded(of_faces);
  Eigen::ArrayXd of_corners(faces_.size()), over_shares(faces_.size());
  for (Eigen::Index s = 0; s < faces_.size(); ++s) {
    of_corners[s] = weights_[corners_[s] / 3];
    over_shares[s] = over_shares_[corners_[s] / 3];
  }
  corner_weights_ = padded(of_corners);
  corner_over_shares_ = padded(over_shares);
  mass_.setZero(static_cast<Eigen::Index>(vertices_.size()));
  for (Eigen::Index c = 0; c < faces_.size(); ++c) {
    mass_[faces_(c)] += weights_[c / 3] / shares_[c / 3];
  }
}

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
    if (blocks_[s][next] != kNone) hessian_[blocks_[s][next]] += ConstBlockMap(terms.coupling[i]);
    if (blocks_[s][last] != kNone) {
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
