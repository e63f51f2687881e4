#pragma once

#include <vector>

#include "spherical_springs/relaxation.h"

namespace spherical_springs::core {

/// Turns what springs join as a whole to lie as near as it can to `start`, unless that raises the
/// energy: nearly antipodal vertices make much of the rounding of a turn. Then measures the
/// energies of `start` and of the result [J]. `calm`: as `aligned` has it.
void turnBack(const System& system, const Points& start, const std::vector<bool>& calm,
              RelaxationResult& result);

}  // namespace spherical_springs::core
