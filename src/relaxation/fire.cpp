#include "relaxation/fire.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "relaxation/particle_stiffness.h"

namespace spherical_springs::core {

void Fire::place(const Points& positions) {
  positions_ = positions;
  velocities_ = Points::Zero(3, positions.cols());
  time_step_ = kFirstStep;
  mixing_ = kFirstMixing;
  downhill_ = age_ = since_least_ = 0;
  allowed_ = allowedTorques(system_, positions_, limit_);
  evaluate();
}

void Fire::evaluate() {
  value_ = system_.potential(positions_).total();
  system_.evaluate(positions_, workspace_);
  for (Eigen::Index i = 0; i < positions_.cols(); ++i) {
    if (system_.pinned(i)) workspace_.torques.col(i).setZero();
  }
  measureExcess();
  if (excess_ > 1 || !limit_.isRelative()) return;
  allowed_ = allowedTorques(system_, positions_, limit_);
  measureExcess();
}

void Fire::measureExcess() {
  excess_ = parallelLargest(positions_.cols(), system_.threads(), [&](std::ptrdiff_t i) {
    return excessOf(workspace_.torques.col(i).norm(), allowed_[i]);
  });
}

double Fire::maxTorque() const {
  return positions_.cols() > 0 ? workspace_.torques.colwise().norm().maxCoeff() : 0;
}

void Fire::stop() {
  constexpr double kCut = 0.5;
  velocities_.setZero();
  time_step_ *= downhill_ > 0 ? kCut : 1;
  mixing_ = kFirstMixing;
  downhill_ = 0;
}

/// Along great circles by the velocities, as far as the guard allows.
void Fire::move() {
  Points moves(3, positions_.cols());
  parallelFor(positions_.cols(), system_.threads(), [&](std::ptrdiff_t i) {
    const Vector3 velocity = velocities_.col(i);
    moves.col(i) = time_step_ * velocity.cross(Vector3(positions_.col(i)));
  });
  double share = 1;
  if (guard_) {
    Eigen::VectorXd hold = Eigen::VectorXd::Zero(positions_.cols());
    share = guard_->allowedShare(positions_, moves, hold);
  }
  parallelFor(positions_.cols(), system_.threads(), [&](std::ptrdiff_t i) {
    if (moves.col(i).isZero(0)) return;  // rounding of the length would move it
    positions_.col(i) = (positions_.col(i) + share * moves.col(i)).normalized();
    velocities_.col(i) -= positions_.col(i).dot(velocities_.col(i)) * positions_.col(i);
  });
  if (share < 1) stop();
}

bool Fire::iterate() {
  constexpr int kInertiaLasts = 50;
  constexpr int kPatience = 20000;  // iterations without a smaller excess
  constexpr int kDelay = 5;
  constexpr double kGrowth = 1.1, kMixingDecay = 0.99;
  constexpr double kLongestStep = 10 * kFirstStep;
  if (age_++ % kInertiaLasts == 0) {
    mobility_ = particleStiffness(system_, positions_).cwiseInverse();
    allowed_ = allowedTorques(system_, positions_, limit_);
  }

  const Points acceleration = workspace_.torques * mobility_.asDiagonal();
  const double power = workspace_.torques.cwiseProduct(velocities_).sum();
  if (power > 0) {
    const double speed = velocities_.norm();
    const double pull = acceleration.norm();
    velocities_ = (1 - mixing_) * velocities_ + (mixing_ * speed / pull) * acceleration;
    if (++downhill_ > kDelay) {
      time_step_ = std::min(kGrowth * time_step_, kLongestStep);
      mixing_ *= kMixingDecay;
    }
  } else {
    stop();
  }
  velocities_ += time_step_ * acceleration;
  move();
  evaluate();

  if (since_least_ == 0 || excess_ < least_excess_) {
    least_excess_ = excess_;
    since_least_ = 0;
  }
  return ++since_least_ < kPatience;
}

}  // namespace spherical_springs::core
