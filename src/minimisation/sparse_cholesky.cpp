#include "sparse_cholesky.h"

#include <algorithm>

namespace spherical_springs::core {

SparseCholesky::SparseCholesky(const BlockPattern& pattern) : pattern_(pattern) {
  const Graph& graph = pattern.graph;
  for (std::uint32_t i = 0; i < pattern.rows(); ++i) {
    first_.push_back(static_cast<std::uint32_t>(places_.size()));
    for (std::uint32_t e = graph.first[i]; e < graph.first[i + 1]; ++e) {
      if (graph.neighbours[e] >= i) places_.push_back(e);
    }
    std::sort(places_.begin() + first_.back(), places_.end(),
              [&](std::uint32_t a, std::uint32_t b) {
                return graph.neighbours[a] < graph.neighbours[b];
              });
  }
  first_.push_back(static_cast<std::uint32_t>(places_.size()));
  copy(Blocks<double, 2>(graph.neighbours.size(), Eigen::Matrix2d::Zero()));
  factor_.analyzePattern(matrix_);
}

/// Fills the lower triangle column by column; rows of the blocks serve as columns by symmetry.
void SparseCholesky::copy(const Blocks<double, 2>& values) {
  const auto size = static_cast<Eigen::Index>(2 * pattern_.rows());
  matrix_.resize(size, size);
  matrix_.reserve(static_cast<Eigen::Index>(4 * places_.size()));
  for (std::size_t i = 0; i < pattern_.rows(); ++i) {
    for (int c = 0; c < 2; ++c) {
      const auto column = static_cast<int>(2 * i) + c;
      matrix_.startVec(column);
      for (std::uint32_t p = first_[i]; p < first_[i + 1]; ++p) {
        for (int r = 0; r < 2; ++r) {
          const auto row = static_cast<int>(2 * pattern_.graph.neighbours[places_[p]]) + r;
          if (row >= column) {
            matrix_.insertBackByOuterInner(column, row) = values[places_[p]](c, r);
          }
        }
      }
    }
  }
  matrix_.finalize();
}

bool SparseCholesky::refresh(const Blocks<double, 2>& values) {
  copy(values);
  factor_.factorize(matrix_);
  return factor_.info() == Eigen::Success;
}

void SparseCholesky::apply(const VectorOf<double>& residual, VectorOf<double>& correction) {
  correction = factor_.solve(residual);
}

}  // namespace spherical_springs::core
