// An approximate inverse of a matrix of 2 x 2 blocks, by aggregation multigrid.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "linear/aggregation.h"
#include "linear/block_matrix.h"
#include "linear/preconditioner.h"

namespace spherical_springs::core {

/// Gauss-Seidel sweeps over a matrix of N x N blocks.
template <class Real, int N>
class GaussSeidel {
 public:
  /// The arguments must live longer.
  GaussSeidel(const BlockPattern& pattern, const Blocks<Real, N>& values, int threads);

  /// Takes other values of the same pattern.
  void refresh(const Blocks<Real, N>& values);

  const BlockPattern& pattern() const { return pattern_; }
  const Blocks<Real, N>& values() const { return *values_; }

  /// `x` after a sweep from 0 towards the solution of matrix x = `b`, and what it leaves of `b`.
  void forward(const VectorOf<Real>& b, VectorOf<Real>& x, VectorOf<Real>& residual) const;

  /// One sweep on from `x`, in the opposite order.
  void backward(const VectorOf<Real>& b, VectorOf<Real>& x) const;

 private:
  const BlockPattern& pattern_;
  const Blocks<Real, N>* values_;
  std::vector<Eigen::Matrix<Real, N, N>> inverse_diagonal_;
  int threads_;
};

/// For each row, the 2 x 3 matrix that takes the three unknowns of the row's aggregate to the two
/// of the row. What these matrices make of one triple for all rows should be the vectors that the
/// matrix hardly changes.
template <class Real>
using CoarseBasis = std::vector<Eigen::Matrix<Real, 2, 3>>;

/// One W-cycle with a Gauss-Seidel sweep before and the opposite one after. As an operator it is
/// linear, symmetric and, for a definite matrix, definite.
template <class Real>
class Multigrid : public Preconditioner<Real> {
 public:
  /// The pattern and the values must live longer.
  Multigrid(const BlockPattern& pattern, const Blocks<Real, 2>& values, CoarseBasis<Real> basis,
            int threads);

  /// Coarse levels stay as they are. `values` must live longer.
  bool refresh(const Blocks<Real, 2>& values) override;
  void apply(const VectorOf<Real>& residual, VectorOf<Real>& correction) override;

 private:
  using Dense = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

  /// A level with its way to the next coarser one.
  template <int N>
  struct Level {
    GaussSeidel<Real, N> smoother;
    Aggregation aggregation;
    VectorOf<Real> residual;
  };
  /// The matrix of a coarse level, and what a cycle works on there.
  struct CoarseMatrix {
    BlockPattern pattern;
    Blocks<Real, 3> values;
    VectorOf<Real> right_hand_side, solution, second_right_hand_side, second_solution;
  };

  template <int N>
  void addCoarser(const BlockPattern& pattern, const Blocks<Real, N>& values, std::size_t size,
                  Aggregation& aggregation);
  template <int N>
  void cycle(Level<N>& level, std::size_t coarser, const VectorOf<Real>& b, VectorOf<Real>& x);
  void visit(std::size_t depth);
  void solveAt(std::size_t depth, const VectorOf<Real>& b, VectorOf<Real>& x);

  int threads_;
  CoarseBasis<Real> basis_;
  Level<2> finest_;
  std::vector<std::unique_ptr<CoarseMatrix>> matrices_;
  std::vector<Level<3>> levels_;  // of all coarse matrices but the last
  Dense coarsest_inverse_;        // of the last matrix, or of the finest if there is no other
};

}  // namespace spherical_springs::core
