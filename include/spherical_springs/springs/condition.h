// The condition that a spring wants to be zero, and its derivatives.
#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include "spherical_springs/sphere.h"

namespace spherical_springs::core {

/// Condition C of a spring on N particles (report, section 3), with energy stiffness C^2 / 2.
template <std::size_t N>
struct Condition {
  double value;  ///< C [rad or sr]
  /// p x grad C for each particle: the rate of C under a rotation of the particle. The torque is
  /// -stiffness C gradient (report's equation 2, in rotation vectors instead of half of them).
  std::array<Vector3, N> gradient;
};

/// Whether the second derivatives H of a condition C are exact; or tempered, exact but for arcs
/// whose negative curvature would outweigh what others may give; or altered so that C H, and with
/// it the spring's share of the energy's Hessian, stiffness (g g^T + C H), is positive
/// semidefinite.
enum class Curvature { exact, tempered, definite };

/// The least value of C H across an arc that counts; lower values are dropped.
constexpr double leastCurvature(Curvature curvature) {
  constexpr double kTempered = -0.3;
  if (curvature == Curvature::definite) return 0;
  return curvature == Curvature::tempered ? kTempered : -std::numeric_limits<double>::infinity();
}

/// Returns false, as for most kinds the torque or the curvature tells which way the energy falls.
template <class Spring>
constexpr bool isFlat(const Spring&, const std::array<Vector3, Spring::kParticles>&) {
  return false;
}

/// Derivatives of the condition in tangent coordinates: particle i moves along frame_i * d_i and
/// back onto the sphere.
template <std::size_t N>
struct TangentCondition {
  double value;                                   ///< C [rad or sr]
  std::array<Vector2, N> gradient;                ///< by the coordinates of each particle
  std::array<std::array<Matrix2, N>, N> hessian;  ///< by those of each pair
};

}  // namespace spherical_springs::core
