#pragma once

#include "spherical_springs/system.h"

namespace spherical_springs::core {

/// For each particle the stiffness of the springs at it [N m], sum of stiffness |gradient|^2, as a
/// scale for steps and torques; never 0.
Eigen::VectorXd particleStiffness(const System& system, const Points& positions);

}  // namespace spherical_springs::core
