#pragma once

#include "linear/block_matrix.h"

namespace spherical_springs::core {

/// An approximate inverse of a symmetric matrix, itself symmetric and positive definite.
template <class Real>
class Preconditioner {
 public:
  virtual ~Preconditioner() = default;

  /// Takes the matrix's present values.
  /// @return false where they are found not to be positive definite; `apply` must then wait.
  virtual bool refresh(const Blocks<Real, 2>& values) = 0;

  /// `correction` = the approximate inverse times `residual`.
  virtual void apply(const VectorOf<Real>& residual, VectorOf<Real>& correction) = 0;
};

}  // namespace spherical_springs::core
