// The yardstick: the same springs relaxed by Ceres Solver.
#pragma once

#include <string>

#include "spherical_springs/system.h"

namespace benchmark_scenes {

struct CeresResult {
  spherical_springs::core::Points positions;
  bool converged = false;  ///< Ceres's own word
  int iterations = 0;
  double seconds = 0;  ///< of ceres::Solve alone, the problem made before
  std::string message;
};

/// Ceres Solver with SphereManifold, automatic derivatives and SPARSE_NORMAL_CHOLESKY on two
/// threads. Residuals are sqrt(stiffness) C, so the energies are those of the system.
/// `tolerance`: of the largest component of a particle's gradient [N m], which is at most the
/// torque. `max_time`: [s].
CeresResult relaxByCeres(const spherical_springs::core::System& system,
                         const spherical_springs::core::Points& positions, double tolerance,
                         double max_time);

}  // namespace benchmark_scenes
