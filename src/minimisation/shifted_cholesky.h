#pragma once

#include <Eigen/SparseCholesky>

#include "tangent_energy.h"

namespace spherical_springs::core {

/// Sparse Cholesky factorisation of the Hessian of an energy + shift * stiffness scale + floor. The
/// pattern is analysed once, so an object serves one system.
class ShiftedCholesky {
 public:
  /// @return whether the matrix is positive definite.
  bool factorise(TangentEnergy& energy, Curvature curvature, double shift, double floor = 0) {
    matrix_ = energy.hessian(curvature);
    matrix_.diagonal().array() += shift * energy.stiffnessScale().array() + floor;
    if (!analysed_) factor_.analyzePattern(matrix_);
    analysed_ = true;
    factor_.factorize(matrix_);
    return factor_.info() == Eigen::Success;
  }

  Eigen::VectorXd solve(const Eigen::VectorXd& right_hand_side) const {
    return factor_.solve(right_hand_side);
  }

  /// x . M x with the matrix last factorised.
  double quadratic(const Eigen::VectorXd& x) const {
    return x.dot(matrix_.selfadjointView<Eigen::Lower>() * x);
  }

 private:
  bool analysed_ = false;
  TangentEnergy::Matrix matrix_;
  Eigen::SimplicialLLT<TangentEnergy::Matrix, Eigen::Lower> factor_;
};

}  // namespace spherical_springs::core
