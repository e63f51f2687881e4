#pragma once

#include <Eigen/SparseCore>
#include <cstdint>
#include <vector>

#include "spherical_springs/system.h"

namespace benchmark_scenes {

using SparseMatrix = Eigen::SparseMatrix<double>;

/// For each particle those that share a spring with it, itself among them, rising.
std::vector<std::vector<std::uint32_t>> neighbours(const spherical_springs::core::System& system);

/// Unknowns 2 i and 2 i + 1 are rotations of the i-th free particle about the axes of its tangent
/// frame [rad]. By fourth-order differences of torques; particles without a neighbour in common are
/// turned together, after A. R. Curtis, M. J. D. Powell and J. K. Reid, IMA J. Appl. Math. 13
/// (1974).
SparseMatrix differenceHessian(const spherical_springs::core::System& system,
                               const spherical_springs::core::Points& positions);

}  // namespace benchmark_scenes
