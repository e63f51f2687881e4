// How fast springs pass places where their conditions have no derivative.
#pragma once

#include <array>
#include <cstddef>

#include "spherical_springs/springs/kinds.h"

namespace spherical_springs::core {

/// The ends of a spring under way: where they are, and one or two velocities that they have there,
/// those before a kick and after it.
template <std::size_t N>
struct MovingEnds {
  std::array<Vector3, N> points;                             ///< unit vectors
  int times;                                                 ///< how many velocities there are
  std::array<std::array<Vector3, N>, 2> angular_velocities;  ///< [rad/s]; 0 for pinned particles
  double largest_inverse_mass;                               ///< [1/kg]; 0 where all are pinned

  /// Returns the velocity of an end [1/s].
  Vector3 velocity(int time, std::size_t end) const {
    return angular_velocities[time][end].cross(points[end]);
  }
};

/// Rates at which a spring passes places where its condition has no derivative [1/s], the largest
/// of those with its velocities; 0 far from any.
struct Approach {
  double turning = 0;   ///< of the gradient, where it turns within a small part of the sphere
  double pull = 0;      ///< of its turn at the speed that the spring may give by the energy it has
  double falling = 0;   ///< of its turn at the speed that all energy it can have may give
  double closing = 0;   ///< speed by distance of a place where the gradient jumps
  double distance = 0;  ///< from the nearer one, as `Passage` has it
  const char* place = "";
};

// Overloads for a kind: whether a spring is near such a place; and its approach, which is 0 where
// it is not.

bool isNear(const AngleSpring& spring, const std::array<Vector3, 2>& points);
Approach approach(const AngleSpring& spring, const MovingEnds<2>& ends);

bool isNear(const SolidAngleSpring& spring, const std::array<Vector3, 3>& points);
Approach approach(const SolidAngleSpring& spring, const MovingEnds<3>& ends);

bool isNear(const OrientedAngleSpring& spring, const std::array<Vector3, 3>& points);
Approach approach(const OrientedAngleSpring& spring, const MovingEnds<3>& ends);

/// A kind of spring that tells of no such place has none.
template <class Spring>
bool isNear(const Spring&, const std::array<Vector3, Spring::kParticles>&) {
  return false;
}
template <class Spring>
Approach approach(const Spring&, const MovingEnds<Spring::kParticles>&) {
  return {};
}

}  // namespace spherical_springs::core
