// How the faces of a map and what is round its vertices lie in memory.
#include <algorithm>

#include "base/parallel.h"
#include "geometry/curve_order.h"
#include "maps/map_energy.h"

namespace spherical_springs::mesh {
namespace {

constexpr std::size_t kSweepBlock = 16;  // vertices that one thread moves in turn

/// Returns the index of the first corner of each vertex in a list by vertices, and its end.
std::vector<std::uint32_t> firstCorners(const Faces& faces, std::size_t vertices) {
  std::vector<std::uint32_t> first(vertices + 1, 0);
  for (Eigen::Index c = 0; c < faces.size(); ++c) ++first[faces(c) + 1];
  for (std::size_t v = 0; v < vertices; ++v) first[v + 1] += first[v];
  return first;
}

/// Returns the graph of the vertices before `free`, all of whose faces are given: the neighbours of
/// a vertex are the next corners of its faces.
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

/// Returns one number a face, and the padding that kernels may read after the last.
std::vector<double> padded(const Eigen::ArrayXd& values) {
  std::vector<double> result(values.size() + kLanePadding, 1);
  std::copy(values.begin(), values.end(), result.begin());
  return result;
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
  blocks_.resize(faces_.size(), {kNoBlock, kNoBlock, kNoBlock});
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

}  // namespace spherical_springs::mesh
