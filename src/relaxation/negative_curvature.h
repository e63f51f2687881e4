#pragma once

#include <Eigen/Core>

#include "linear/multifrontal_cholesky.h"

namespace spherical_springs::core {

/// Returns numbers in [-1, 1], the same at every call.
Eigen::VectorXd scattered(Eigen::Index size);

/// Returns a vector x with x . H x < 0, beyond `negligible` times x . D x, or an empty one where
/// there is none, which one factorisation tells. `inverse` is made for the pattern of H, whose
/// blocks are `hessian`; `scale` is the diagonal of D, one number above 0 for each block.
Eigen::VectorXd negativeCurvature(MultifrontalCholesky& inverse, const BlockPattern& pattern,
                                  const Blocks<double, 2>& hessian, const Eigen::VectorXd& scale,
                                  double negligible);

}  // namespace spherical_springs::core
