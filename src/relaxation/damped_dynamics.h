#pragma once

#include <memory>

#include "relaxation/descent.h"
#include "relaxation/orientation_guard.h"
#include "relaxation/torque_limit.h"
#include "spherical_springs/plan.h"
#include "spherical_springs/state.h"
#include "stepping/blocked_splitting.h"

namespace spherical_springs::core {

/// The report's way: the scene's own motion, with its masses and damping, by `verlet` at half of
/// the stable step. All comes to rest at each peak of the kinetic energy (P. Cundall's kinetic
/// damping), so that a scene without damping settles too.
class DampedDynamics : public Descent {
 public:
  /// Steps are cut before what `guard` forbids; null: nothing is forbidden. Both must live longer.
  DampedDynamics(const System& system, OrientationGuard* guard, const TorqueLimit& limit);
  void place(const Points& positions) override;
  bool iterate() override;
  const char* whyStuck() const override {
    return "20000 steps brought the largest torque no nearer to the tolerance";
  }
  Points positions() const override { return state_.positions; }
  double value() const override { return value_; }
  double maxTorque() const override { return max_torque_; }
  double excess() const override { return excess_; }

 private:
  void chooseTimeStep();
  void keepOrientation(const Points& from);
  void stop();
  void measure();

  const System& system_;
  std::shared_ptr<const Plan> plan_;
  OrientationGuard* guard_;
  std::unique_ptr<BlockedSplitting> integrator_;
  State state_;
  double value_ = 0, kinetic_ = 0;  // [J]
  double max_torque_ = 0;           // [N m]
  TorqueLimit limit_;
  Eigen::VectorXd allowed_;  // torques, at positions of a while ago where the limit is relative
  double excess_ = 0;
  double least_excess_ = 0;
  std::uint64_t least_excess_step_ = 0;
};

}  // namespace spherical_springs::core
