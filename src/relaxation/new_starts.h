// Places from which a relaxation that is stuck starts again, and springs that make it do so.
#pragma once

#include <string>

#include "spherical_springs/system.h"

namespace spherical_springs::core {

/// A spring in messages, such as "angle spring 7", by its index in the system.
template <class Spring>
std::string nameOf(const System& system, std::size_t index) {
  return Spring::kName + (" " + std::to_string(system.springId<Spring>(index)));
}

/// The positions with every free particle displaced by up to `share` of its longest arc to another
/// particle of its springs, in directions that depend on `seed` alone.
Points displaced(const System& system, Points positions, double share, unsigned seed);

/// The `distanceToUndefined` below which the torque of a spring says little.
inline constexpr double kUndefined = 1e-6;

/// Names the first spring that is nearer than `near` to a place where its condition is undefined,
/// and not at rest there; empty when there is none.
std::string undefinedSpring(const System& system, const Points& positions,
                            double near = kUndefined);

/// Returns the positions with the free particles of all springs that are nearer than `kUndefined`
/// moved by `distance` [rad], each in a direction that depends on `seed` alone.
Points besideUndefined(const System& system, Points positions, double distance, unsigned seed);

/// Returns the positions with the free particles of all springs that are flat (`isFlat`) moved by
/// `distance` [rad], each in a direction that depends on `seed` alone.
Points besideFlat(const System& system, Points positions, double distance, unsigned seed);

}  // namespace spherical_springs::core
