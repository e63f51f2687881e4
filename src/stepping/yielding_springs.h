// Kicks of springs that are too stiff for their step.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "spherical_springs/springs/kinds.h"

namespace spherical_springs::core {

/// A spring that is too stiff for the step.
struct StiffSpring {
  double stiffness;                                ///< [J/rad^2] or [J/sr^2]
  std::array<std::uint32_t, kMostEnds> particles;  ///< indices of its ends
  std::array<Vector3, kMostEnds> gradient;         ///< by rotation vectors of its ends
  std::size_t ends;                                ///< how many of these there are
};

/// Reduces torques [N m] over a step of `duration` [s] as if the springs' particles had more mass
/// along the gradients, so that the swings of these springs are slow enough for the step. Where the
/// springs rest, and the angular momentum, stay as they are.
void yieldTo(const std::vector<StiffSpring>& springs, const std::vector<double>& inverse_masses,
             double duration, std::vector<Vector3>& torques);

}  // namespace spherical_springs::core
