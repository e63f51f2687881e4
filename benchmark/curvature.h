// Whether the energy has a minimum somewhere, apart from any code that relaxes.
#pragma once

#include "difference_hessian.h"
#include "spherical_springs/system.h"

namespace benchmark_scenes {

struct EigenvalueRange {
  double smallest = 0;   ///< eigenvalue of the Hessian, rotations of whole components aside [N m]
  double largest = 0;    ///< [N m]
  bool resolved = true;  ///< false: Lanczos iterations did not settle, and `smallest` means nothing
};

/// Eigenvalues of the Hessian by differences: all up to 1,300 unknowns; beyond, Lanczos iterations,
/// which resolve `smallest` to about 1e-8 of the largest.
EigenvalueRange eigenvalueRange(const spherical_springs::core::System& system,
                                const SparseMatrix& hessian,
                                const spherical_springs::core::Points& positions);

/// How negative the Hessian may be: the least power of ten, from 1e-14 to 1, which makes it
/// positive definite as an addition to its diagonal, each unknown first scaled to a diagonal of 1
/// (so that soft particles count as much as stiff ones; the number of negative eigenvalues is the
/// same).
double leastDefiniteShift(const SparseMatrix& hessian);

}  // namespace benchmark_scenes
