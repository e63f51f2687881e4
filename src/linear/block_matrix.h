// Sparse symmetric matrices of small dense blocks.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <vector>

#include "base/shuffled.h"
#include "linear/graph.h"

namespace spherical_springs::core {

/// Where a matrix has blocks: whole rows, each with its diagonal block.
struct BlockPattern {
  /// The columns of each row, in the rank of `order`, so that those before the diagonal come first
  /// in a sweep by that order.
  Graph graph;
  std::vector<std::uint32_t> diagonal;  ///< place of the diagonal block of each row
  BlockOrder order;                     ///< of the rows

  BlockPattern() = default;
  /// `graph`: its nodes in an order that is local.
  BlockPattern(Graph graph, int threads);

  std::size_t rows() const { return graph.size(); }

  /// Place of the block at `row` and `column`, which must be there.
  std::uint32_t place(std::uint32_t row, std::uint32_t column) const {
    const auto begin = graph.neighbours.begin();
    return static_cast<std::uint32_t>(
        std::lower_bound(
            begin + graph.first[row], begin + graph.first[row + 1], column,
            [&](std::uint32_t a, std::uint32_t b) { return order.rank[a] < order.rank[b]; }) -
        begin);
  }
};

/// Columns of three have a zero more, so that each fills a register.
template <class Real, int N>
using Block = Eigen::Matrix<Real, N == 3 ? 4 : N, N>;

template <class Real, int N>
using Blocks = std::vector<Block<Real, N>>;

template <class Real>
using VectorOf = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

/// The `i`th part of `N` numbers of a vector.
template <int N, class Real>
Eigen::Map<const Eigen::Matrix<Real, N, 1>> part(const VectorOf<Real>& vector, std::size_t i) {
  return Eigen::Map<const Eigen::Matrix<Real, N, 1>>(vector.data() + N * i);
}
template <int N, class Real>
Eigen::Map<Eigen::Matrix<Real, N, 1>> part(VectorOf<Real>& vector, std::size_t i) {
  return Eigen::Map<Eigen::Matrix<Real, N, 1>>(vector.data() + N * i);
}

/// Sum of block times part of `x` over the places from `begin` to `end`.
template <class Real, int N>
inline Eigen::Matrix<Real, N, 1> rowProduct(const Graph& graph, const Blocks<Real, N>& values,
                                            const VectorOf<Real>& x, std::uint32_t begin,
                                            std::uint32_t end) {
  Eigen::Matrix<Real, N, 1> sum = Eigen::Matrix<Real, N, 1>::Zero();
  for (std::uint32_t e = begin; e < end; ++e) {
    sum += values[e].template topRows<N>().lazyProduct(part<N>(x, graph.neighbours[e]));
  }
  return sum;
}

using FourFloats = float __attribute__((vector_size(16)));

inline FourFloats load(const float* from) {
  FourFloats result;
  std::memcpy(&result, from, sizeof(result));
  return result;
}

/// The row product in single precision, with one instruction for all products of a 2 x 2 block.
template <>
inline Eigen::Vector2f rowProduct(const Graph& graph, const Blocks<float, 2>& values,
                                  const VectorOf<float>& x, std::uint32_t begin,
                                  std::uint32_t end) {
  using Two = double __attribute__((vector_size(16)));
  FourFloats sum = {};
  for (std::uint32_t e = begin; e < end; ++e) {
    double pair;  // of floats
    std::memcpy(&pair, x.data() + 2 * graph.neighbours[e], sizeof(pair));
    const auto pairs = reinterpret_cast<FourFloats>(Two{pair, pair});
    const auto factors = shuffled<0, 0, 1, 1>(pairs, pairs);
    sum += load(values[e].data()) * factors;
  }
  return {sum[0] + sum[2], sum[1] + sum[3]};
}

/// The row product in single precision, with one instruction for all products of a column of three.
template <>
inline Eigen::Vector3f rowProduct(const Graph& graph, const Blocks<float, 3>& values,
                                  const VectorOf<float>& x, std::uint32_t begin,
                                  std::uint32_t end) {
  FourFloats sum = {};
  for (std::uint32_t e = begin; e < end; ++e) {
    const float* const block = values[e].data();
    const float* const from = x.data() + 3 * graph.neighbours[e];
    sum += load(block) * from[0] + load(block + 4) * from[1] + load(block + 8) * from[2];
  }
  return {sum[0], sum[1], sum[2]};
}

}  // namespace spherical_springs::core
