// How well the springs of a relaxed scene hold its particles.
#pragma once

#include <cstdint>
#include <vector>

#include "spherical_springs/system.h"

namespace spherical_springs::core {

/// A symmetric matrix by coordinates in space.
using Matrix3 = Unaligned<double, 3, 3>;

/// Returns, for each of `particles` (indices), the block of the energy's inverse Hessian in the
/// scene's axes [rad^2/J], a matrix whose kernel is along the particle. Where each spring is a
/// measurement and its stiffness the inverse of the variance, the energy is chi^2 / 2 and this is
/// the covariance of the particle's place [rad^2], to first order in the errors (R. J. Barlow,
/// Statistics, 1989, section 6.4). Rotations that the springs leave open
/// (`RelaxationResult::free_rotations`) are taken out: it is the inverse on their complement, the
/// covariance of a scene that is turned as near as it can be to the true one. Zero for a pinned
/// particle. `positions`: a minimum of the energy, one unit vector a particle.
/// @throw std::invalid_argument where the positions are not at a minimum, where no spring, or next
/// to none, holds one of `particles`, or where the springs are so many that it would take minutes.
/// \snippet test_headers.cpp covariance
std::vector<Matrix3> covariances(const System& system, const Points& positions,
                                 const std::vector<std::uint32_t>& particles);

}  // namespace spherical_springs::core
