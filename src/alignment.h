#pragma once

#include "spherical_springs/system.h"

namespace spherical_springs::core {

/// Turns every group of particles that springs join so that it lies as close as it can to where it
/// was, in the sense of least squares: as a whole where none is pinned, about the pinned one where
/// there is one (or an antipodal pair), not at all where more are. Energies do not change.
/// Columns of both arguments are particles in the order of their ids.
/// The turn is that of W. Kabsch, Acta Cryst. A32 (1976).
Points aligned(const System& system, const Points& before, Points after);

}  // namespace spherical_springs::core
