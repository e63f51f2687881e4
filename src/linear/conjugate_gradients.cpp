#include "linear/conjugate_gradients.h"

#include <cmath>

namespace spherical_springs::core {
namespace {

template <class Real>
double dot(const VectorOf<Real>& a, const VectorOf<Real>& b, int threads) {
  return parallelSum(a.size() / 2, threads, [&](std::ptrdiff_t i) {
    return static_cast<double>(part<2>(a, i).dot(part<2>(b, i)));
  });
}

/// @return x . product.
template <class Real>
double multiply(const BlockPattern& pattern, const Blocks<Real, 2>& matrix, const VectorOf<Real>& x,
                VectorOf<Real>& product, int threads) {
  const Graph& graph = pattern.graph;
  return parallelSum(pattern.rows(), threads, [&](std::ptrdiff_t i) {
    const Eigen::Matrix<Real, 2, 1> row =
        rowProduct<Real, 2>(graph, matrix, x, graph.first[i], graph.first[i + 1]);
    part<2>(product, i) = row;
    return static_cast<double>(part<2>(x, i).dot(row));
  });
}

}  // namespace

template <class Real>
ModelMinimum minimise(const BlockPattern& pattern, const Blocks<Real, 2>& matrix,
                      Preconditioner<Real>& preconditioner, const Eigen::VectorXd& gradient,
                      const Eigen::VectorXd& weights, double tolerance, int most_iterations,
                      int threads) {
  const double scale = gradient.norm();
  VectorOf<Real> residual = (-gradient / scale).template cast<Real>();
  VectorOf<Real> step = VectorOf<Real>::Zero(gradient.size());
  VectorOf<Real> preconditioned(gradient.size()), product(gradient.size());
  preconditioner.apply(residual, preconditioned);
  VectorOf<Real> direction = preconditioned;
  double descent = dot(residual, preconditioned, threads);
  const double weighted = std::sqrt(parallelSum(pattern.rows(), threads, [&](std::ptrdiff_t i) {
    return weights[i] * weights[i] * part<2>(residual, i).squaredNorm();
  }));

  ModelMinimum result;
  while (result.iterations < most_iterations) {
    ++result.iterations;
    const double curvature = multiply(pattern, matrix, direction, product, threads);
    if (!(curvature > 0)) {
      result.indefinite = true;
      result.downward = direction.template cast<double>();
      break;
    }
    const double length = descent / curvature;
    const double left = std::sqrt(parallelSum(pattern.rows(), threads, [&](std::ptrdiff_t i) {
      part<2>(step, i) += Real(length) * part<2>(direction, i);
      part<2>(residual, i) -= Real(length) * part<2>(product, i);
      return weights[i] * weights[i] * part<2>(residual, i).squaredNorm();
    }));
    result.residual = left / weighted;
    if (result.residual <= tolerance) break;
    preconditioner.apply(residual, preconditioned);
    const double next = dot(residual, preconditioned, threads);
    const Real ratio = static_cast<Real>(next / descent);
    parallelFor(pattern.rows(), threads, [&](std::ptrdiff_t i) {
      part<2>(direction, i) = part<2>(preconditioned, i) + ratio * part<2>(direction, i);
    });
    descent = next;
  }
  result.step = scale * step.template cast<double>();
  return result;
}

template ModelMinimum minimise(const BlockPattern&, const Blocks<float, 2>&, Preconditioner<float>&,
                               const Eigen::VectorXd&, const Eigen::VectorXd&, double, int, int);
template ModelMinimum minimise(const BlockPattern&, const Blocks<double, 2>&,
                               Preconditioner<double>&, const Eigen::VectorXd&,
                               const Eigen::VectorXd&, double, int, int);

}  // namespace spherical_springs::core
