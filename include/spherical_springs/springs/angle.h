#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "spherical_springs/range.h"
#include "spherical_springs/springs/condition.h"

namespace spherical_springs::core {

/// Angle spring (report, section 3.1): C = angle between two particles - rest_angle.
/// \snippet test_headers.cpp angle
struct AngleSpring {
  static constexpr std::size_t kParticles = 2;  ///< that a spring joins
  static constexpr std::size_t kCorners = 2;    ///< the first particles: the ends of an arc
  /// The name of the list of such springs in messages and files.
  static constexpr const char* kTable = "angle_springs";
  static constexpr const char* kName = "angle spring";  ///< in messages, before an id

  std::array<std::uint32_t, kParticles> particles{};  ///< ids in a scene, indices in a system
  double rest_angle = 0;                              ///< [rad]
  double stiffness = 0;                               ///< [J/rad^2]
  double damping = 0;                                 ///< [N m s/rad]
  bool at_rest = false;  ///< true: rest_angle is ignored and the present angle is taken

  /// Returns the rest value of the condition's quantity [rad].
  double restValue() const { return rest_angle; }

  /// Calls `visit(name, value, range)` for each number that has a range of allowed values.
  template <class Spring, class Visitor>
  static void visitFields(Spring& spring, Visitor&& visit) {
    visit("rest_angle", spring.rest_angle, Range{0, kPi, "0 to pi [rad]"});
    visit("stiffness", spring.stiffness,
          Range{kSmallest, kLargest, "above 0, from 1e-30 to 1e30 [J/rad^2]"});
    visit("damping", spring.damping, Range{0, kLargest, "0 to 1e30 [N m s/rad]"});
  }
};

/// Takes the present angle [rad] between two unit vectors as the rest angle.
void rest(AngleSpring& spring, const std::array<Vector3, 2>& points);

/// Returns infinity, as the angle is defined everywhere.
constexpr double distanceToUndefined(const AngleSpring&, const std::array<Vector3, 2>&) {
  return std::numeric_limits<double>::infinity();
}

/// Returns C [rad] and its gradients at two unit vectors. Where they coincide or are antipodal the
/// gradient is along the fixed axis of `arc`.
Condition<2> condition(const AngleSpring& spring, const std::array<Vector3, 2>& points);

/// Returns C [rad] and its derivatives in the tangent frames at two unit vectors. Points within
/// 1e-12 of coinciding or antipodal are treated as if at that distance, so that the product of
/// value and Hessian keeps its limit for a rest angle of 0 or pi.
TangentCondition<2> tangentCondition(const AngleSpring& spring,
                                     const std::array<Vector3, 2>& points,
                                     const std::array<TangentFrame, 2>& frames,
                                     Curvature curvature);

}  // namespace spherical_springs::core
