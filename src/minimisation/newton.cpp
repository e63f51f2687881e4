#include "newton.h"

#include <algorithm>
#include <cmath>

namespace spherical_springs::core {
namespace {

constexpr double kLongestMove = 0.5;  // of a particle in one step [rad]
constexpr double kRounding = 1e-13;   // of an energy, a sum over all springs

double longestMove(const Eigen::VectorXd& step) {
  double squared = 0;
  for (Eigen::Index u = 0; u < step.size(); u += 2) {
    squared = std::max(squared, step.segment<2>(u).squaredNorm());
  }
  return std::sqrt(squared);
}

}  // namespace

/// Tries the step of the present factorisation; a step that does not help is taken back.
bool Newton::tryStep(TangentEnergy& energy, double& expected_drop) {
  Eigen::VectorXd step = -cholesky_.solve(energy.gradient());
  step *= std::min(1., kLongestMove / longestMove(step));
  expected_drop = -energy.gradient().dot(step) - 0.5 * cholesky_.quadratic(step);

  const Points start = energy.positions();
  const double value = energy.value();
  const double gradient_norm = energy.gradient().norm();
  energy.moveTo(energy.moved(step));
  const double drop = value - energy.value();
  // Where the energy cannot resolve the drop any more, the gradient still can.
  const bool resolved = expected_drop > kRounding * value;
  if (resolved ? drop > 1e-4 * expected_drop : energy.gradient().norm() < gradient_norm) {
    if (!resolved || drop > 0.75 * expected_drop) shift_ = std::max(shift_ / 10, kLeastShift);
    return true;
  }
  energy.moveTo(start);
  return false;
}

void Newton::restart() {
  shift_ = kLeastShift;
  iterations_ = 0;
}

/// Whether hundreds of iterations have brought next to nothing, as on the way into a place where
/// the energy has no derivative.
bool Newton::creeps(double value) {
  constexpr int kWindow = 300;
  constexpr double kNextToNothing = 1e-6;
  if (iterations_++ % kWindow != 0) return false;
  const bool first = iterations_ == 1;
  const bool creeping = !first && value > (1 - kNextToNothing) * earlier_value_;
  earlier_value_ = value;
  return creeping;
}

bool Newton::iterate(TangentEnergy& energy) {
  constexpr double kGreatestShift = 1e12;
  if (creeps(energy.value())) return false;
  for (; shift_ < kGreatestShift; shift_ = std::max(10 * shift_, 1e-6)) {
    if (!cholesky_.factorise(energy, Curvature::exact, shift_) &&
        !cholesky_.factorise(energy, Curvature::definite, shift_)) {
      continue;
    }
    double expected_drop;
    if (tryStep(energy, expected_drop)) return true;
    if (expected_drop <= kRounding * energy.value()) break;
  }
  shift_ = kLeastShift;
  return false;
}

}  // namespace spherical_springs::core
