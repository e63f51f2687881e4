#include "maps/fold_free_start.h"

#include <cmath>
#include <cstdint>

#include "maps/schnyder_wood.h"

namespace spherical_springs::mesh {
namespace {

using Weights = std::vector<std::int64_t>;

/// Sum of all weights. Barycentric coordinates are then multiples of 1 / kTotal, and the triple
/// product of a face's corners, each on its own ray from the centre, is at least
/// 0.77 / kTotal^2 = 4e-14, where rounding of the corners makes no more than 1e-15 of it.
constexpr std::int64_t kTotal = std::int64_t(1) << 22;

/// Whole numbers above 0 about proportional to the shares; 0 for the face `without`.
Weights wholeWeights(const Eigen::VectorXd& shares, Eigen::Index without) {
  const double sum = shares.sum() - shares[without];
  const double scale = static_cast<double>(kTotal - shares.size()) / sum;
  Weights weights(shares.size());
  for (Eigen::Index f = 0; f < shares.size(); ++f) {
    weights[f] = f == without ? 0 : 1 + static_cast<std::int64_t>(scale * shares[f]);
  }
  return weights;
}

/// For each vertex the weight of the faces whose angle of the label is at the vertex or at one
/// below it in the tree of that label.
Weights subtreeWeights(const SchnyderWood& wood, const Weights& weights, int label) {
  Weights sums(wood.parents.size(), 0);
  for (std::size_t f = 0; f < weights.size(); ++f) {
    if (weights[f] > 0) sums[wood.corners[f][label]] += weights[f];
  }
  const auto add = [&](SchnyderWood::Index v) {
    const SchnyderWood::Index parent = wood.parents[v][label];
    if (parent != HalfEdges::kNone) sums[parent] += sums[v];
  };
  if (label == 2) {
    for (auto v = wood.order.rbegin(); v != wood.order.rend(); ++v) add(*v);
  } else {
    for (const auto v : wood.order) add(v);
  }
  return sums;
}

/// Sums of `values` over the path from each vertex to the root of `tree`.
Weights pathSums(const SchnyderWood& wood, Weights values, int tree) {
  const auto add = [&](SchnyderWood::Index v) {
    const SchnyderWood::Index parent = wood.parents[v][tree];
    if (parent != HalfEdges::kNone) values[v] += values[parent];
  };
  if (tree == 2) {
    for (const auto v : wood.order) add(v);
  } else {
    for (auto v = wood.order.rbegin(); v != wood.order.rend(); ++v) add(*v);
  }
  return values;
}

/// The weight of each vertex's region opposite to the root of `label`: all angles of that label on
/// its two sides, and in the trees that hang on them.
Weights regionWeights(const SchnyderWood& wood, const Weights& weights, int label) {
  const Weights subtrees = subtreeWeights(wood, weights, label);
  Weights region = pathSums(wood, subtrees, (label + 1) % 3);
  const Weights other_side = pathSums(wood, subtrees, (label + 2) % 3);
  for (std::size_t v = 0; v < region.size(); ++v) region[v] += other_side[v] - subtrees[v];
  return region;
}

Points lifted(const SchnyderWood& wood, const Weights& weights) {
  Eigen::Matrix<double, 3, 4> corners;  // of a regular tetrahedron
  corners << 1, -1, -1, 1,              //
      1, 1, -1, -1,                     //
      1, -1, 1, -1;
  const auto count = static_cast<Eigen::Index>(wood.parents.size());
  Points points = Points::Zero(3, count + 1);
  for (int label = 0; label < 3; ++label) {
    const Weights region = regionWeights(wood, weights, label);
    for (Eigen::Index v = 0; v < count; ++v) {
      points.col(v) += static_cast<double>(region[v]) * corners.col(label);
    }
  }
  for (int label = 0; label < 3; ++label) points.col(wood.roots[label]) = corners.col(label);
  points.col(count) = corners.col(3);
  points.colwise().normalize();
  return points;
}

}  // namespace

FoldFreeStart foldFreeStart(const Faces& faces, const HalfEdges& edges, std::size_t vertices,
                            const Eigen::VectorXd& shares, Eigen::Index cut) {
  const auto wood = schnyderWood(edges, vertices, static_cast<HalfEdges::Index>(cut));

  FoldFreeStart start;
  start.points = lifted(wood, wholeWeights(shares, cut));
  const Eigen::Index count = faces.cols();
  start.faces.resize(3, count + 2);
  start.shares.resize(count + 2);
  Eigen::Index kept = 0;
  for (Eigen::Index f = 0; f < count; ++f) {
    if (f == cut) continue;
    start.faces.col(kept) = faces.col(f);
    start.shares[kept++] = shares[f];
  }
  for (int k = 0; k < 3; ++k) {
    start.faces.col(kept) << faces(k, cut), faces((k + 1) % 3, cut),
        static_cast<std::int32_t>(vertices);
    start.shares[kept++] = shares[cut] / 3;
  }
  return start;
}

}  // namespace spherical_springs::mesh
