#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "spherical_springs/range.h"
#include "spherical_springs/springs/condition.h"

namespace spherical_springs::core {

/// Oriented-angle spring (report, section 3.3, an empty heading; section 6 says what it is for):
/// C = sign * (angle between the first two particles) - rest_angle, where the sign is a smooth step
/// of width `width` in the triple product of the three particles.
/// \snippet test_headers.cpp oriented_angle
struct OrientedAngleSpring {
  static constexpr std::size_t kParticles = 3;  ///< that a spring joins
  static constexpr std::size_t kCorners = 2;    ///< the first particles: the ends of an arc
  /// The name of the list of such springs in messages and files.
  static constexpr const char* kTable = "oriented_angle_springs";
  static constexpr const char* kName = "oriented-angle spring";  ///< in messages, before an id

  std::array<std::uint32_t, kParticles> particles{};  ///< ids in a scene, indices in a system
  double rest_angle = 0;  ///< [rad]; negative: at rest when seen clockwise
  double stiffness = 0;   ///< [J/rad^2]
  double damping = 0;     ///< [N m s/rad]
  double width = 0;       ///< of the change of sign, in units of the triple product; 0: the default
  bool at_rest = false;   ///< true: rest_angle is ignored and the present signed angle is taken

  /// Returns the rest value of the condition's quantity [rad].
  double restValue() const { return rest_angle; }

  /// Calls `visit(name, value, range)` for each number that has a range of allowed values.
  template <class Spring, class Visitor>
  static void visitFields(Spring& spring, Visitor&& visit) {
    visit("rest_angle", spring.rest_angle, Range{-kPi, kPi, "-pi to pi [rad]"});
    visit("stiffness", spring.stiffness,
          Range{kSmallest, kLargest, "above 0, from 1e-30 to 1e30 [J/rad^2]"});
    visit("damping", spring.damping, Range{0, kLargest, "0 to 1e30 [N m s/rad]"});
    visit("width", spring.width, Range{0, 1, "0 (the default) to 1"});
  }
};

/// The width in use: `width`, or 0.2 sin^2(rest_angle / 2) where that is 0. Below 1e-12, near the
/// rounding of the triple product, the change of sign is a sharp step, reported as 0.
double effectiveWidth(const OrientedAngleSpring& spring);

/// Takes the present signed angle as the rest angle; a default width is then that of the present
/// angle, and is written into the spring.
void rest(OrientedAngleSpring& spring, const std::array<Vector3, 3>& points);

/// Returns infinity, as the signed angle is defined everywhere.
constexpr double distanceToUndefined(const OrientedAngleSpring&, const std::array<Vector3, 3>&) {
  return std::numeric_limits<double>::infinity();
}

/// Returns whether the first two of three unit vectors are within 1e-3 of each other, and C is not
/// small beside the rest angle. The energy falls there as the angle times the triple product, odd
/// in the way between the two, which neither torque nor curvature need show.
bool isFlat(const OrientedAngleSpring& spring, const std::array<Vector3, 3>& points);

/// Returns C [rad] and its gradients at three unit vectors; where the first two coincide or are
/// antipodal, as for an angle spring.
Condition<3> condition(const OrientedAngleSpring& spring, const std::array<Vector3, 3>& points);

/// Returns C [rad] and its derivatives in the tangent frames at three unit vectors.
TangentCondition<3> tangentCondition(const OrientedAngleSpring& spring,
                                     const std::array<Vector3, 3>& points,
                                     const std::array<TangentFrame, 3>& frames,
                                     Curvature curvature);

}  // namespace spherical_springs::core
