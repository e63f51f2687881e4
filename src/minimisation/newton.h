#pragma once

#include "descent.h"
#include "shifted_cholesky.h"

namespace spherical_springs::core {

/// Newton's method with the shift of Levenberg and Marquardt: the exact Hessian where it is
/// positive definite, a definite part of it elsewhere.
class Newton : public Descent {
 public:
  bool iterate(TangentEnergy& energy) override;
  void restart() override;

 private:
  static constexpr double kLeastShift = 1e-10;  // rotations of the whole scene need one

  bool tryStep(TangentEnergy& energy, double& expected_drop);

  bool creeps(double value);

  double shift_ = kLeastShift;
  int iterations_ = 0;
  double earlier_value_ = 0;
  ShiftedCholesky cholesky_;
};

}  // namespace spherical_springs::core
