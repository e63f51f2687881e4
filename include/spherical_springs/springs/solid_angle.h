#pragma once

#include <array>
#include <cstdint>

#include "spherical_springs/range.h"
#include "spherical_springs/springs/condition.h"

namespace spherical_springs::core {

/// Solid-angle spring (report, section 3.2): C = signed area of a spherical triangle -
/// rest_solid_angle, taken modulo 4 pi into [-2 pi, 2 pi], as the area of an oriented triangle is
/// only defined modulo 4 pi. Positive for vertices counter-clockwise seen from outside (the report
/// says clockwise, which needs left-handed axes).
/// \snippet test_headers.cpp solid_angle
struct SolidAngleSpring {
  static constexpr std::size_t kParticles = 3;  ///< that a spring joins
  static constexpr std::size_t kCorners = 3;    ///< of a triangle
  /// The name of the list of such springs in messages and files.
  static constexpr const char* kTable = "solid_angle_springs";
  static constexpr const char* kName = "solid-angle spring";  ///< in messages, before an id

  std::array<std::uint32_t, kParticles> particles{};  ///< ids in a scene, indices in a system
  double rest_solid_angle = 0;                        ///< [sr]
  double stiffness = 0;                               ///< [J/sr^2]
  double damping = 0;                                 ///< as for the other springs, with C in [sr]
  bool at_rest = false;  ///< true: rest_solid_angle is ignored and the present one is taken

  /// Returns the rest value of the condition's quantity [sr].
  double restValue() const { return rest_solid_angle; }

  /// Calls `visit(name, value, range)` for each number that has a range of allowed values.
  template <class Spring, class Visitor>
  static void visitFields(Spring& spring, Visitor&& visit) {
    visit("rest_solid_angle", spring.rest_solid_angle,
          Range{-2 * kPi, 2 * kPi, "above -2 pi, up to 2 pi [sr]", true});
    visit("stiffness", spring.stiffness,
          Range{kSmallest, kLargest, "above 0, from 1e-30 to 1e30 [J/sr^2]"});
    visit("damping", spring.damping, Range{0, kLargest, "0 to 1e30 [N m s rad/sr^2]"});
  }
};

/// Takes the present solid angle [sr] of three unit vectors as the one at rest.
void rest(SolidAngleSpring& spring, const std::array<Vector3, 3>& points);

/// Returns how far three unit vectors are from a place where the solid angle is undefined and
/// torques grow without limit: for two vertices nearly antipodal, the arc [rad] that they lack,
/// times the sine of the arc from the third vertex to either.
double distanceToUndefined(const SolidAngleSpring& spring, const std::array<Vector3, 3>& points);

/// Returns C [sr] and its gradients at three unit vectors, by the formula of Oosterom and Strackee
/// 1983. With an antipodal pair of vertices the area is undefined: it counts as 0, and the gradient
/// is zero.
Condition<3> condition(const SolidAngleSpring& spring, const std::array<Vector3, 3>& points);

/// Returns C [sr] and its derivatives in the tangent frames at three unit vectors.
TangentCondition<3> tangentCondition(const SolidAngleSpring& spring,
                                     const std::array<Vector3, 3>& points,
                                     const std::array<TangentFrame, 3>& frames,
                                     Curvature curvature);

}  // namespace spherical_springs::core
