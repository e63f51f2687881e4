#include "fire.h"

#include <algorithm>
#include <cmath>

namespace spherical_springs::core {

bool Fire::iterate(TangentEnergy& energy) {
  constexpr int kInertiaLasts = 50;
  constexpr int kPatience = 20000;  // iterations without a smaller gradient
  constexpr int kDelay = 5;
  constexpr double kGrowth = 1.1, kCut = 0.5, kMixingDecay = 0.99;
  constexpr double kLongestStep = 10 * kFirstStep;
  if (age_ == 0) velocities_ = Points::Zero(3, energy.positions().cols());
  if (age_++ % kInertiaLasts == 0) mobility_ = energy.mobility();

  const Points acceleration = energy.torques() * mobility_.asDiagonal();
  const double power = energy.torques().cwiseProduct(velocities_).sum();
  if (power > 0) {
    const double speed = velocities_.norm();
    const double pull = acceleration.norm();
    velocities_ = (1 - mixing_) * velocities_ + (mixing_ * speed / pull) * acceleration;
    if (++downhill_ > kDelay) {
      time_step_ = std::min(kGrowth * time_step_, kLongestStep);
      mixing_ *= kMixingDecay;
    }
  } else {
    velocities_.setZero();
    time_step_ *= downhill_ > 0 ? kCut : 1;
    mixing_ = kFirstMixing;
    downhill_ = 0;
  }
  velocities_ += time_step_ * acceleration;

  Points positions = energy.positions();
  for (Eigen::Index i = 0; i < positions.cols(); ++i) {
    positions.col(i) = rotated(positions.col(i), time_step_ * velocities_.col(i));
    velocities_.col(i) -= positions.col(i).dot(velocities_.col(i)) * positions.col(i);
  }
  energy.moveTo(positions);

  const double gradient = energy.gradient().norm();
  if (since_least_ == 0 || gradient < least_gradient_) {
    least_gradient_ = gradient;
    since_least_ = 0;
  }
  return ++since_least_ < kPatience;
}

}  // namespace spherical_springs::core
