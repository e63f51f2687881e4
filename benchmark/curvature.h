// The Hessian of the energy by differences of torques, apart from any code that relaxes.
#pragma once

#include "spherical_springs/system.h"

namespace benchmark_scenes {

struct EigenvalueRange {
  double smallest = 0;   ///< eigenvalue of the Hessian, rotations of whole components aside [N m]
  double largest = 0;    ///< [N m]
  bool resolved = true;  ///< false: Lanczos iterations did not settle, and `smallest` means nothing
};

/// The Hessian is that of differences of fourth order, in rotations of the free particles about
/// two axes each. All of its eigenvalues up to 1,300 unknowns; beyond, Lanczos iterations, which
/// resolve `smallest` to about 1e-8 of the largest.
EigenvalueRange eigenvalueRange(const spherical_springs::core::System& system,
                                const spherical_springs::core::Points& positions);

}  // namespace benchmark_scenes
