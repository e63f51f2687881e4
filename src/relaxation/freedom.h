// The freedom that the springs of a relaxed scene leave, and their distance from rest.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "relaxation/free_groups.h"
#include "spherical_springs/relaxation.h"

namespace spherical_springs::core {

/// For each group the difference of its energy that says nothing [J]. `energies` and `stiffness`:
/// one entry a group.
Eigen::VectorXd roundingOf(const Eigen::VectorXd& energies, const Eigen::VectorXd& stiffness);

/// Returns for each group whether its mirror image has another energy.
std::vector<bool> mirrorImagesDiffer(const FreeGroups& groups, const Points& positions);

/// Fills in `free_rotations`, `mirror_ambiguous` and `rms_strain` of a result, from its positions
/// and its energy.
void judge(const System& system, RelaxationResult& result);

}  // namespace spherical_springs::core
