// The freedom that the springs of a relaxed scene leave, and their distance from rest.
#pragma once

#include <Eigen/Core>

#include "spherical_springs/relaxation.h"

namespace spherical_springs::core {

/// For each group the difference of its energy that says nothing [J]. `energies` and `stiffness`:
/// one entry a group.
Eigen::VectorXd roundingOf(const Eigen::VectorXd& energies, const Eigen::VectorXd& stiffness);

/// Fills in what a result says of the measurements: `free_rotations`, `mirror_ambiguous` and
/// `rms_strain`, at its positions.
void judge(const System& system, RelaxationResult& result);

}  // namespace spherical_springs::core
