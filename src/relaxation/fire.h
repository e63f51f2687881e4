#pragma once

#include "relaxation/descent.h"
#include "relaxation/orientation_guard.h"
#include "relaxation/torque_limit.h"
#include "spherical_springs/system.h"

namespace spherical_springs::core {

/// Damped stepping: the fast inertial relaxation engine of Bitzek, Koskinen, Gaehler, Moseler and
/// Gumbsch, Phys. Rev. Lett. 97, 170201 (2006), with its published constants. Inertias are the
/// local stiffness, so that every particle swings at about the same rate, and a swing is the unit
/// of time.
class Fire : public Descent {
 public:
  /// Steps are cut before what `guard` forbids; null: nothing is forbidden. Both must live longer.
  Fire(const System& system, OrientationGuard* guard, const TorqueLimit& limit)
      : system_(system), guard_(guard), limit_(limit) {}
  void place(const Points& positions) override;
  bool iterate() override;
  const char* whyStuck() const override {
    return "20000 iterations brought the largest torque no nearer to the tolerance";
  }
  Points positions() const override { return positions_; }
  double value() const override { return value_; }
  double maxTorque() const override;
  double excess() const override { return excess_; }

 private:
  static constexpr double kFirstStep = 0.1, kFirstMixing = 0.1;

  void evaluate();
  void measureExcess();
  void stop();
  void move();

  const System& system_;
  OrientationGuard* guard_;
  Points positions_;
  System::Workspace workspace_;
  double value_ = 0;
  TorqueLimit limit_;
  Eigen::VectorXd allowed_;  // torques, at positions of a while ago where the limit is relative
  double excess_ = 0;
  Points velocities_;         // angular
  Eigen::VectorXd mobility_;  // of each particle, 1 / inertia; 0 where pinned
  double time_step_ = kFirstStep, mixing_ = kFirstMixing;
  int downhill_ = 0;  // iterations since the power was last negative
  int age_ = 0;       // iterations
  double least_excess_ = 0;
  int since_least_ = 0;  // iterations since the excess was least
};

}  // namespace spherical_springs::core
