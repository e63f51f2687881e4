#include "linear/multigrid.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <utility>

namespace spherical_springs::core {
namespace {

constexpr std::size_t kFinestGroup = 14, kCoarseGroup = 8;  // rows of an aggregate
constexpr std::size_t kFewRows = 24;                        // solved at once
/// Unsmoothed aggregates make the coarse matrix too stiff; D. Braess, Computing 55 (1995).
constexpr double kOverCorrection = 1.8;

/// Relative shift of the diagonal, which keeps a singular block invertible.
template <class Real>
constexpr Real kShift = std::is_same_v<Real, float> ? Real(1e-5) : Real(1e-9);

template <class Real, int N>
Eigen::Matrix<Real, N, N> shiftedInverse(Eigen::Matrix<Real, N, N> block) {
  const Real trace = block.trace();
  if (!(trace > 0)) return Eigen::Matrix<Real, N, N>::Zero();
  block /= trace;  // so that no power of it leaves the range of numbers
  block.diagonal().array() += kShift<Real>;
  return block.inverse() / trace;
}

template <class Real, int N>
Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic> denseInverse(const BlockPattern& pattern,
                                                                 const Blocks<Real, N>& values) {
  const auto size = static_cast<Eigen::Index>(N * pattern.rows());
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(size, size);
  for (std::size_t i = 0; i < pattern.rows(); ++i) {
    for (std::uint32_t e = pattern.graph.first[i]; e < pattern.graph.first[i + 1]; ++e) {
      dense.block<N, N>(N * i, N * pattern.graph.neighbours[e]) =
          values[e].template topRows<N>().template cast<double>();
    }
  }
  if (size == 0) return {};
  dense.diagonal().array() += kShift<Real> * dense.diagonal().maxCoeff() + 1e-300;
  return dense.llt().solve(Eigen::MatrixXd::Identity(size, size)).template cast<Real>();
}

template <class Real, int N>
std::vector<float> strengths(const BlockPattern& pattern, const Blocks<Real, N>& values,
                             int threads) {
  std::vector<float> result(values.size());
  parallelFor(pattern.rows(), threads, [&](std::ptrdiff_t i) {
    for (std::uint32_t e = pattern.graph.first[i]; e < pattern.graph.first[i + 1]; ++e) {
      // In double precision no square of what single precision holds is 0.
      result[e] = static_cast<float>(values[e].template cast<double>().norm());
    }
  });
  return result;
}

}  // namespace

template <class Real, int N>
GaussSeidel<Real, N>::GaussSeidel(const BlockPattern& pattern, const Blocks<Real, N>& values,
                                  int threads)
    : pattern_(pattern), threads_(worthwhileThreads(pattern.rows(), threads)) {
  refresh(values);
}

template <class Real, int N>
void GaussSeidel<Real, N>::refresh(const Blocks<Real, N>& values) {
  values_ = &values;
  inverse_diagonal_.resize(pattern_.rows());
  forOnThreads(pattern_.rows(), threads_, [&](std::ptrdiff_t i) {
    inverse_diagonal_[i] =
        shiftedInverse<Real, N>(values[pattern_.diagonal[i]].template topRows<N>());
  });
}

template <class Real, int N>
void GaussSeidel<Real, N>::forward(const VectorOf<Real>& b, VectorOf<Real>& x,
                                   VectorOf<Real>& residual) const {
  const Graph& graph = pattern_.graph;
  pattern_.order.apart.forEach(threads_, [&](std::size_t block) {
    for (std::uint32_t i = pattern_.order.first_node[block];
         i < pattern_.order.first_node[block + 1]; ++i) {
      const Eigen::Matrix<Real, N, 1> left =
          part<N>(b, i) -
          rowProduct<Real, N>(graph, *values_, x, graph.first[i], pattern_.diagonal[i]);
      part<N>(x, i) = inverse_diagonal_[i].lazyProduct(left);
    }
  });
  // The residual of a row was 0 when it was swept; the rows after it have changed it since.
  forOnThreads(pattern_.rows(), threads_, [&](std::ptrdiff_t i) {
    part<N>(residual, i) =
        -rowProduct<Real, N>(graph, *values_, x, pattern_.diagonal[i] + 1, graph.first[i + 1]);
  });
}

template <class Real, int N>
void GaussSeidel<Real, N>::backward(const VectorOf<Real>& b, VectorOf<Real>& x) const {
  const Graph& graph = pattern_.graph;
  pattern_.order.apart.forEachBackward(threads_, [&](std::size_t block) {
    for (std::uint32_t i = pattern_.order.first_node[block + 1];
         i-- > pattern_.order.first_node[block];) {
      const Eigen::Matrix<Real, N, 1> left =
          part<N>(b, i) -
          rowProduct<Real, N>(graph, *values_, x, graph.first[i], graph.first[i + 1]);
      part<N>(x, i) += inverse_diagonal_[i].lazyProduct(left);
    }
  });
}

template <class Real>
Multigrid<Real>::Multigrid(const BlockPattern& pattern, const Blocks<Real, 2>& values,
                           CoarseBasis<Real> basis, int threads)
    : threads_(threads),
      basis_(std::move(basis)),
      finest_{GaussSeidel<Real, 2>(pattern, values, threads), {}, {}} {
  if (pattern.rows() <= kFewRows) {
    coarsest_inverse_ = denseInverse<Real, 2>(pattern, values);
    return;
  }
  finest_.residual.resize(2 * pattern.rows());
  addCoarser<2>(pattern, values, kFinestGroup, finest_.aggregation);
  while (matrices_.back()->pattern.rows() > kFewRows) {
    const CoarseMatrix& last = *matrices_.back();
    Level<3> level{GaussSeidel<Real, 3>(last.pattern, last.values, threads), {}, {}};
    level.residual.resize(3 * last.pattern.rows());
    addCoarser<3>(last.pattern, last.values, kCoarseGroup, level.aggregation);
    levels_.push_back(std::move(level));
  }
  coarsest_inverse_ = denseInverse<Real, 3>(matrices_.back()->pattern, matrices_.back()->values);
}

template <class Real>
template <int N>
void Multigrid<Real>::addCoarser(const BlockPattern& pattern, const Blocks<Real, N>& values,
                                 std::size_t size, Aggregation& aggregation) {
  aggregation = aggregated(pattern, strengths<Real, N>(pattern, values, threads_), size);
  auto coarse = std::make_unique<CoarseMatrix>();
  coarse->pattern = BlockPattern(coarseGraph(pattern, aggregation, threads_), threads_);

  const std::size_t rows = coarse->pattern.rows();
  coarse->values.assign(coarse->pattern.graph.neighbours.size(), Block<Real, 3>::Zero());
  parallelFor(rows, threads_, [&](std::ptrdiff_t a) {
    for (std::uint32_t m = aggregation.first_member[a]; m < aggregation.first_member[a + 1]; ++m) {
      const std::uint32_t i = aggregation.members[m];
      for (std::uint32_t e = pattern.graph.first[i]; e < pattern.graph.first[i + 1]; ++e) {
        const std::uint32_t j = pattern.graph.neighbours[e];
        const std::uint32_t b = aggregation.aggregate[j];
        if (b == Aggregation::kNone) continue;
        auto& sum = coarse->values[coarse->pattern.place(a, b)];
        if constexpr (N == 2) {
          sum.template topRows<3>() += basis_[i].transpose() * (values[e] * basis_[j]);
        } else {
          sum += values[e];
        }
      }
    }
  });
  for (VectorOf<Real>* vector : {&coarse->right_hand_side, &coarse->solution,
                                 &coarse->second_right_hand_side, &coarse->second_solution}) {
    vector->resize(3 * rows);
  }
  matrices_.push_back(std::move(coarse));
}

template <class Real>
bool Multigrid<Real>::refresh(const Blocks<Real, 2>& values) {
  finest_.smoother.refresh(values);
  if (matrices_.empty()) {
    coarsest_inverse_ = denseInverse<Real, 2>(finest_.smoother.pattern(), values);
  }
  return true;
}

template <class Real>
void Multigrid<Real>::apply(const VectorOf<Real>& residual, VectorOf<Real>& correction) {
  if (matrices_.empty()) {
    correction.noalias() = coarsest_inverse_ * residual;
  } else {
    cycle(finest_, 0, residual, correction);
  }
}

template <class Real>
template <int N>
void Multigrid<Real>::cycle(Level<N>& level, std::size_t coarser, const VectorOf<Real>& b,
                            VectorOf<Real>& x) {
  level.smoother.forward(b, x, level.residual);

  CoarseMatrix& coarse = *matrices_[coarser];
  const Aggregation& aggregation = level.aggregation;
  parallelFor(aggregation.size(), threads_, [&](std::ptrdiff_t a) {
    Eigen::Matrix<Real, 3, 1> sum = Eigen::Matrix<Real, 3, 1>::Zero();
    for (std::uint32_t m = aggregation.first_member[a]; m < aggregation.first_member[a + 1]; ++m) {
      const std::uint32_t i = aggregation.members[m];
      if constexpr (N == 2) {
        sum += basis_[i].transpose().lazyProduct(part<2>(level.residual, i));
      } else {
        sum += part<3>(level.residual, i);
      }
    }
    part<3>(coarse.right_hand_side, a) = sum;
  });
  visit(coarser);
  parallelFor(aggregation.aggregate.size(), threads_, [&](std::ptrdiff_t i) {
    if (aggregation.aggregate[i] == Aggregation::kNone) return;
    const Eigen::Matrix<Real, 3, 1> coarse_part =
        Real(kOverCorrection) * part<3>(coarse.solution, aggregation.aggregate[i]);
    if constexpr (N == 2) {
      part<2>(x, i) += basis_[i].lazyProduct(coarse_part);
    } else {
      part<3>(x, i) += coarse_part;
    }
  });

  level.smoother.backward(b, x);
}

/// Solves at a coarse level, twice unless that is exact: the second time for what the first left.
template <class Real>
void Multigrid<Real>::visit(std::size_t depth) {
  CoarseMatrix& matrix = *matrices_[depth];
  solveAt(depth, matrix.right_hand_side, matrix.solution);
  if (depth == levels_.size()) return;
  const Graph& graph = matrix.pattern.graph;
  parallelFor(matrix.pattern.rows(), threads_, [&](std::ptrdiff_t i) {
    part<3>(matrix.second_right_hand_side, i) =
        part<3>(matrix.right_hand_side, i) - rowProduct<Real, 3>(graph, matrix.values,
                                                                 matrix.solution, graph.first[i],
                                                                 graph.first[i + 1]);
  });
  solveAt(depth, matrix.second_right_hand_side, matrix.second_solution);
  matrix.solution += matrix.second_solution;
}

template <class Real>
void Multigrid<Real>::solveAt(std::size_t depth, const VectorOf<Real>& b, VectorOf<Real>& x) {
  if (depth == levels_.size()) {
    x.noalias() = coarsest_inverse_ * b;
  } else {
    cycle(levels_[depth], depth + 1, b, x);
  }
}

template class Multigrid<float>;
template class Multigrid<double>;

}  // namespace spherical_springs::core
