// The way of Newton's method out of saddles.
#include "relaxation/negative_curvature.h"
#include "relaxation/newton.h"

namespace spherical_springs::core {
namespace {

constexpr double kNegligible = 1e-6;  // curvature below 0, of the stiffness

}  // namespace

/// Forgets a scale that is far above the present stiffness somewhere, as where the way has led to
/// particles on one spot: beside it negative curvature would seem negligible.
void Newton::scaleToHere() {
  constexpr double kFarAbove = 100;
  bool far_above = false;
  for (Eigen::Index i = 0; i < scale_.size() && !far_above; ++i) {
    far_above = scale_[i] > kFarAbove * stiffnessAt(i);
  }
  if (!far_above) return;
  scale_.setZero();
  model_ = Model::definite;
  evaluate();
}

bool Newton::leaveSaddle() {
  if (energy_.freeCount() == 0) return false;
  shift_ = kNegligible;
  scaleToHere();
  if (model_ == Model::definite || model_ == Model::tempered) {
    model_ = Model::exact;
    evaluate();
  }
  const Eigen::VectorXd downward = downwardDirection();
  return downward.size() > 0 && goAlong(downward / longestMove(downward));
}

/// Returns a direction of negative curvature, or an empty one where none is found: for certain in a
/// small scene; by conjugate gradients elsewhere.
Eigen::VectorXd Newton::downwardDirection() {
  constexpr std::size_t kSmall = 1000;  // particles
  constexpr double kLittleWork = 1e7;   // multiplications
  constexpr double kProbeTolerance = 3e-2;
  const BlockPattern& pattern = energy_.pattern();
  if (pattern.rows() <= kSmall) {
    MultifrontalCholesky inverse(pattern, threads_);
    if (inverse.work() <= kLittleWork) {
      return negativeCurvature(inverse, pattern, energy_.hessian(), scale_, kNegligible);
    }
  }
  const Eigen::VectorXd probe = scattered(energy_.gradient().size());
  const ModelMinimum found = minimum(probe, kProbeTolerance);
  if (!found.indefinite || model_ == Model::indefinite) return found.downward;
  model_ = Model::indefinite;
  evaluate();
  return minimum(probe, kProbeTolerance).downward;
}

/// Moves along a direction as far as that lowers the energy by more than rounding.
bool Newton::goAlong(const Eigen::VectorXd& direction) {
  const double value = energy_.value();
  energy_.mark();
  for (double length = 0.1; length > 1e-9; length /= 4) {
    for (const double sign : {1., -1.}) {
      if (guard_ && allowedShare(sign * length * direction) < 1) continue;
      energy_.move(sign * length * direction);
      evaluate();
      if (energy_.value() < (1 - kEnergyRounding) * value) {
        place(positions());
        return true;
      }
      energy_.goBack();
    }
  }
  evaluate();
  return false;
}

}  // namespace spherical_springs::core
