#pragma once

#include "../minimisation/multifrontal_cholesky.h"
#include "map_energy.h"

namespace spherical_springs::mesh {

/// Newton's method with the shift of Levenberg and Marquardt, each unknown's by the inverse shares
/// round its vertex. A step is cut until no face folds and the energy falls.
class MapDescent {
 public:
  /// `energy` must live longer.
  MapDescent(MapEnergy& energy, int threads);

  /// @return the share of the energy by which it has fallen; 0 where no step lowers it.
  double iterate(FaceHessian hessian);

 private:
  /// @return whether the shifted Hessian was definite.
  bool solve();
  double expectedDrop(double length) const;
  void adaptShift(double length, double ratio);

  MapEnergy& energy_;
  core::MultifrontalCholesky inverse_;
  MapEnergy::Hessian shifted_;
  Eigen::VectorXd step_;
  double shift_ = 1e-2;
};

}  // namespace spherical_springs::mesh
