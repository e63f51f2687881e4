#include "relaxation/model_solver.h"

#include "linear/multifrontal_cholesky.h"
#include "linear/multigrid.h"

namespace spherical_springs::core {
namespace {

constexpr int kMostIterations = 300;
constexpr int kTooMany = 100;  // iterations under a multigrid that suits the matrix

}  // namespace

/// `hessian` in another precision, with the shifts on its diagonal.
template <class Real>
void ModelSolver::shift(const TangentEnergy::Hessian& hessian, const Eigen::VectorXd& shifts,
                        Blocks<Real, 2>& result) const {
  const Graph& graph = pattern_.graph;
  result.resize(hessian.size());
  parallelFor(pattern_.rows(), threads_, [&](std::ptrdiff_t i) {
    for (std::uint32_t e = graph.first[i]; e < graph.first[i + 1]; ++e) {
      result[e] = hessian[e].template cast<Real>();
    }
    result[pattern_.diagonal[i]].diagonal().array() += static_cast<Real>(shifts[i]);
  });
}

template <class Real, class MakePreconditioner>
ModelMinimum ModelSolver::solve(InPrecision<Real>& in, const TangentEnergy& energy,
                                const TangentEnergy::Hessian* definite,
                                const Eigen::VectorXd& shifts, const Eigen::VectorXd& weights,
                                const Eigen::VectorXd& gradient, double tolerance,
                                const MakePreconditioner& make) {
  shift(energy.hessian(), shifts, in.hessian);
  if (definite) shift(*definite, shifts, in.definite);
  const Blocks<Real, 2>& values = definite ? in.definite : in.hessian;
  if (!in.preconditioner) in.preconditioner = make(values);
  if (!in.preconditioner->refresh(values)) {
    ModelMinimum none;
    none.indefinite = true;
    return none;
  }
  const int most = cholesky_refused_ ? kMostIterations : kTooMany;
  return minimise(pattern_, in.hessian, *in.preconditioner, gradient, weights, tolerance, most,
                  threads_);
}

/// Whether a factorisation can take over from the multigrid, and is there now.
bool ModelSolver::tryCholesky() {
  constexpr std::size_t kMostRows = 50'000;
  constexpr double kMostWork = 3e10;  // multiplications; seconds each time
  if (cholesky_refused_) return false;
  cholesky_refused_ = true;
  if (pattern_.rows() > kMostRows) return false;
  auto cholesky = std::make_unique<MultifrontalCholesky>(pattern_, threads_);
  if (cholesky->work() > kMostWork) return false;
  double_.preconditioner = std::move(cholesky);
  return true;
}

ModelMinimum ModelSolver::minimum(const TangentEnergy& energy,
                                  const TangentEnergy::Hessian* definite,
                                  const Eigen::VectorXd& shifts, const Eigen::VectorXd& weights,
                                  const Eigen::VectorXd& gradient, double tolerance) {
  if (!double_.preconditioner) {
    const auto make = [&](const Blocks<float, 2>& values) {
      return std::make_unique<Multigrid<float>>(pattern_, values,
                                                energy.places().rotations<float>(), threads_);
    };
    auto result = solve(single_, energy, definite, shifts, weights, gradient, tolerance, make);
    if (result.indefinite || result.residual <= tolerance || !tryCholesky()) return result;
    single_ = {};
  }
  const auto make = [&](const Blocks<double, 2>&) {
    return std::make_unique<MultifrontalCholesky>(pattern_, threads_);
  };
  return solve(double_, energy, definite, shifts, weights, gradient, tolerance, make);
}

}  // namespace spherical_springs::core
