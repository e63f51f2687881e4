#pragma once

#include "linear/multifrontal_cholesky.h"
#include "maps/map_energy.h"

namespace spherical_springs::mesh {

/// Newton's method with the shift of Levenberg and Marquardt, each unknown's by the inverse shares
/// round its vertex. A step is cut until no face folds and the energy falls.
class MapDescent {
 public:
  /// `energy` must live longer. What `checkpoint` throws ends a step, with vertices where they
  /// were.
  MapDescent(MapEnergy& energy, int threads, const core::Checkpoint& checkpoint = core::passAll);

  /// Begins anew, wherever vertices are now.
  void restart() { shift_ = kFirstShift; }

  /// @return whether a step has lowered the energy.
  bool iterate(FaceHessian hessian);

  /// Iterates while `go_on()`, until a step lowers the energy by no more than the share `slow`, or,
  /// where it was held short, by no more than rounding; or until none lowers it.
  template <class GoOn>
  void run(FaceHessian hessian, double slow, const GoOn& go_on) {
    while (go_on() && iterate(hessian) && drop_ > (held_short_ ? kRounding : slow)) {
    }
  }

  /// Runs with a sweep over the vertices after each step.
  template <class GoOn>
  void runWithSweeps(FaceHessian hessian, double slow, const GoOn& go_on) {
    bool moved = false;
    run(hessian, slow, [&] {
      if (moved) energy_.sweep();
      moved = true;
      return go_on();
    });
  }

 private:
  static constexpr double kFirstShift = 1e-2;
  static constexpr double kRounding = 1e-13;  // of the energy, which cuts steps short at a minimum

  /// @return whether the shifted Hessian was definite.
  bool solve();
  double expectedDrop(double length) const;
  void adaptShift(double length, double ratio, bool may_fall);

  MapEnergy& energy_;
  core::MultifrontalCholesky inverse_;
  MapEnergy::Hessian shifted_;
  Eigen::VectorXd step_;
  double shift_ = kFirstShift;
  bool held_short_ = false;  // the last step, which the next will not be as much
  double drop_ = 0;          // of the energy in the last step, as a share
};

}  // namespace spherical_springs::mesh
