#pragma once

#include "spherical_springs/system.h"

namespace spherical_springs::core {

/// A bound of the highest frequency of small vibrations here [rad/s], by Gershgorin's circles of
/// the Hessian's blocks; 0 where nothing vibrates.
double highestFrequency(const System& system, const Points& positions);

}  // namespace spherical_springs::core
