#pragma once

#include "descent.h"

namespace spherical_springs::core {

/// Damped stepping: the fast inertial relaxation engine of Bitzek, Koskinen, Gaehler, Moseler and
/// Gumbsch, Phys. Rev. Lett. 97, 170201 (2006), with its published constants. Inertias are the
/// local stiffness, so that every particle swings at about the same rate, and a swing is the unit
/// of time.
class Fire : public Descent {
 public:
  bool iterate(TangentEnergy& energy) override;
  void restart() override { *this = Fire(); }

 private:
  static constexpr double kFirstStep = 0.1, kFirstMixing = 0.1;

  Points velocities_;         // angular
  Eigen::VectorXd mobility_;  // of each particle, 1 / inertia; 0 where pinned
  double time_step_ = kFirstStep, mixing_ = kFirstMixing;
  int downhill_ = 0;  // iterations since the power was last negative
  int age_ = 0;       // iterations
  double least_gradient_ = 0;
  int since_least_ = 0;  // iterations since the gradient was least
};

}  // namespace spherical_springs::core
