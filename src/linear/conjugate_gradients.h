// The minimum of a quadratic model.
#pragma once

#include <Eigen/Core>

#include "linear/preconditioner.h"

namespace spherical_springs::core {

struct ModelMinimum {
  Eigen::VectorXd step;  ///< in the unknowns of the matrix
  double residual = 1;   ///< what is left of the weighted gradient, relative
  int iterations = 0;
  bool indefinite = false;   ///< whether the model was found to have no minimum
  Eigen::VectorXd downward;  ///< then: a direction along which it goes down without end, if known
};

/// Minimises gradient . x + x . matrix x / 2 by preconditioned conjugate gradients, until
/// `tolerance` of the gradient is left, for `most_iterations`, or to the first direction without
/// positive curvature. `weights`: one factor for each block of the gradient in the norm that the
/// tolerance is about, such as the inverse of its stiffness; otherwise what little is left at stiff
/// particles would hide all that soft ones have to go.
template <class Real>
ModelMinimum minimise(const BlockPattern& pattern, const Blocks<Real, 2>& matrix,
                      Preconditioner<Real>& preconditioner, const Eigen::VectorXd& gradient,
                      const Eigen::VectorXd& weights, double tolerance, int most_iterations,
                      int threads);

}  // namespace spherical_springs::core
