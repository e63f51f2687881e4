#include "relaxation/negative_curvature.h"

#include <random>

namespace spherical_springs::core {

Eigen::VectorXd scattered(Eigen::Index size) {
  std::mt19937 generator(1);
  Eigen::VectorXd result(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    result[i] = generator() / (0.5 * std::mt19937::max()) - 1;
  }
  return result;
}

// H + s D has a Cholesky factor where no eigenvalue of H x = lambda D x is below -s. Inverse
// iteration with the least s that has one, to a factor of 4, leads to the lowest eigenvalue.
Eigen::VectorXd negativeCurvature(MultifrontalCholesky& inverse, const BlockPattern& pattern,
                                  const Blocks<double, 2>& hessian, const Eigen::VectorXd& scale,
                                  double negligible) {
  constexpr double kRaise = 4, kMostShift = 1e100;  // next to one spot arcs bend without limit
  constexpr int kMostIterations = 100;
  Blocks<double, 2> shifted;
  const auto factorise = [&](double shift) {
    shifted = hessian;
    for (std::size_t i = 0; i < pattern.rows(); ++i) {
      shifted[pattern.diagonal[i]].diagonal().array() += shift * scale[i];
    }
    return inverse.refresh(shifted);
  };
  if (factorise(negligible)) return {};
  double shift = kRaise * negligible;
  while (!factorise(shift)) {
    shift *= kRaise;
    if (!(shift < kMostShift)) return {};
  }
  Eigen::VectorXd diagonal(2 * scale.size());
  for (Eigen::Index i = 0; i < scale.size(); ++i) diagonal.segment<2>(2 * i).setConstant(scale[i]);
  Eigen::VectorXd next, x = scattered(diagonal.size());
  for (int i = 0; i < kMostIterations; ++i) {
    const Eigen::VectorXd from = diagonal.cwiseProduct(x);
    inverse.apply(from, next);
    const double mass = next.dot(diagonal.cwiseProduct(next));
    const double curvature = next.dot(from) - shift * mass;
    x = next / next.norm();
    if (curvature < -negligible * mass) return x;
  }
  return {};
}

}  // namespace spherical_springs::core
