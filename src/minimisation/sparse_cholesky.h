#pragma once

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <cstdint>
#include <vector>

#include "preconditioner.h"

namespace spherical_springs::core {

/// The exact inverse, by a sparse Cholesky factorisation: for matrices that a multigrid does not
/// suit, as long as the factor is not too large.
class SparseCholesky : public Preconditioner<double> {
 public:
  explicit SparseCholesky(const BlockPattern& pattern);

  /// Multiplications of one factorisation.
  double work() const { return factor_.work(); }

  bool refresh(const Blocks<double, 2>& values) override;
  void apply(const VectorOf<double>& residual, VectorOf<double>& correction) override;

 private:
  using Matrix = Eigen::SparseMatrix<double>;

  /// With a look at what the analysis has found.
  struct Factor : Eigen::SimplicialLLT<Matrix, Eigen::Lower> {
    double work() const { return m_nonZerosPerCol.cast<double>().squaredNorm(); }
  };

  void copy(const Blocks<double, 2>& values);

  const BlockPattern& pattern_;
  // Places of the blocks that each column has in the lower triangle, rising.
  std::vector<std::uint32_t> first_, places_;
  Matrix matrix_;  // the lower triangle
  Factor factor_;
};

}  // namespace spherical_springs::core
