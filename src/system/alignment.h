#pragma once

#include <vector>

#include "spherical_springs/system.h"

namespace spherical_springs::core {

/// Turns every group of particles that springs join so that it lies as close as it can to where it
/// was, in the sense of least squares: as a whole where none is pinned, about the pinned one where
/// there is one (or an antipodal pair), not at all where more are. Energies do not change.
/// Columns of both arguments are particles in the order of their ids.
/// The turn is that of W. Kabsch, Acta Cryst. A32 (1976).
///
/// A particle without springs and a group that has not moved keep the bits of `before`. So does a
/// group that has moved by less than 1e-6 rad and was `calm` before: one flag a particle, whether
/// nothing pulled at it; none for a scene in which all are to go where they have come to.
Points aligned(const System& system, const Points& before, Points after,
               const std::vector<bool>& calm = {});

}  // namespace spherical_springs::core
