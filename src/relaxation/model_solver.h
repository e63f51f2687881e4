#pragma once

#include <memory>

#include "linear/conjugate_gradients.h"
#include "relaxation/tangent_energy.h"

namespace spherical_springs::core {

/// Minimises quadratic models of one energy after another of the same springs. What it has prepared
/// goes on serving: a multigrid in single precision or, where that takes too many iterations and
/// the factor is not too large, a Cholesky factorisation in double.
class ModelSolver {
 public:
  /// `pattern` must live longer.
  ModelSolver(const BlockPattern& pattern, int threads) : pattern_(pattern), threads_(threads) {}

  /// The model of `gradient` and the energy's Hessian, with `shifts` (one a free particle) added to
  /// the diagonal. `definite`: a matrix whose inverse preconditions; null for the Hessian's own.
  /// `weights`: one a free particle, as `minimise` has them.
  /// @return the minimum, with `tolerance` of the weighted gradient left, or somewhat more where
  /// that is out of reach.
  ModelMinimum minimum(const TangentEnergy& energy, const TangentEnergy::Hessian* definite,
                       const Eigen::VectorXd& shifts, const Eigen::VectorXd& weights,
                       const Eigen::VectorXd& gradient, double tolerance);

 private:
  template <class Real>
  struct InPrecision {
    Blocks<Real, 2> hessian, definite;
    std::unique_ptr<Preconditioner<Real>> preconditioner;
  };

  template <class Real>
  void shift(const TangentEnergy::Hessian& hessian, const Eigen::VectorXd& shifts,
             Blocks<Real, 2>& result) const;
  template <class Real, class MakePreconditioner>
  ModelMinimum solve(InPrecision<Real>& in, const TangentEnergy& energy,
                     const TangentEnergy::Hessian* definite, const Eigen::VectorXd& shifts,
                     const Eigen::VectorXd& weights, const Eigen::VectorXd& gradient,
                     double tolerance, const MakePreconditioner& make);
  bool tryCholesky();

  const BlockPattern& pattern_;
  int threads_;
  InPrecision<float> single_;
  InPrecision<double> double_;
  bool cholesky_refused_ = false;
};

}  // namespace spherical_springs::core
