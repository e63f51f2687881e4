#include "stepping/approach.h"

#include <algorithm>
#include <cmath>

#include "springs/solid_angle_value.h"
#include "stepping/nearness.h"

namespace spherical_springs::core {
namespace {

/// Speed by distance, with 0 for what stands still anywhere.
double rate(double speed, double distance) {
  constexpr double kNearest = 1e-150;
  return speed > 0 ? speed / std::max(distance, kNearest) : 0;
}

/// Speed by distance from a jump. A step that crosses it from less than `kNearest` makes an error
/// that is as small.
double closingRate(double speed, double distance) {
  constexpr double kNearest = 1e-9;  // of a chord, or of an area [sr]
  return rate(speed, std::max(distance, kNearest));
}

double nearMeeting(double rest_angle) { return std::min(kNearPair, kNearPairShare * rest_angle); }

double nearAntipode(double rest_angle) {
  return std::min(kNearPair, kNearPairShare * (kPi - rest_angle));
}

bool isPairNear(double rest, const Vector3& a, const Vector3& b) {
  const double cosine = a.dot(b);
  const double meeting = nearMeeting(rest), antipode = nearAntipode(rest);
  return 2 - 2 * cosine < meeting * meeting || 2 + 2 * cosine < antipode * antipode;
}

template <std::size_t N>
Approach approachOfPair(double rest, const MovingEnds<N>& ends) {
  const Vector3 &a = ends.points[0], &b = ends.points[1];
  const double chord = (b - a).norm(), supplement = (a + b).norm();
  const bool meets = chord < nearMeeting(rest);
  Approach result;
  if (!meets && supplement >= nearAntipode(rest)) return result;
  result.distance = meets ? chord : supplement;
  result.place = meets ? "the place where its ends meet" : "antipodal ends";
  for (int time = 0; time < ends.times; ++time) {
    const Vector3 of_a = ends.velocity(time, 0), of_b = ends.velocity(time, 1);
    const double speed = meets ? (of_b - of_a).norm() : (of_a + of_b).norm();
    result.closing = std::max(result.closing, closingRate(speed, result.distance));
  }
  return result;
}

/// Whether two edges of a triangle add up so far that the area can be near its jump.
bool mayBeNearJump(const SolidAngleSpring& spring, double denominator) {
  return denominator <= 0 || std::abs(spring.rest_solid_angle) > kPi - kNearJump;
}

/// Returns the distance from the jump of the area [sr], for small ones, and 2 where it is far. The
/// area is 2 arg z with z = denominator + i triple_product, and jumps where half of the area at
/// rest is the argument of -z.
double distanceToJump(const SolidAngleSpring& spring, const Triangle& t) {
  constexpr double kFar = 2;
  if (!mayBeNearJump(spring, t.denominator)) return kFar;
  const double sine = std::sin(spring.rest_solid_angle / 2);
  const double cosine = std::cos(spring.rest_solid_angle / 2);
  if (t.denominator * cosine + t.triple_product * sine >= 0) return kFar;
  const double across = t.triple_product * cosine - t.denominator * sine;
  return 2 * std::abs(across) / std::sqrt(t.squared_norm);
}

/// Returns whether a distance, as `distanceToJump` has it, is less than kNearJump.
bool isNearJump(double distance) {
  constexpr double kChord = 0.95885;  // 2 sin (kNearJump / 2)
  return distance < kChord;
}

}  // namespace

bool isNear(const AngleSpring& spring, const std::array<Vector3, 2>& points) {
  return isPairNear(spring.rest_angle, points[0], points[1]);
}

Approach approach(const AngleSpring& spring, const MovingEnds<2>& ends) {
  return approachOfPair(spring.rest_angle, ends);
}

bool isNear(const SolidAngleSpring& spring, const std::array<Vector3, 3>& points) {
  const auto& [a, b, c] = points;
  const double ab = a.dot(b), bc = b.dot(c), ca = c.dot(a);
  if (2 * (1 + ab) * (1 + bc) * (1 + ca) < kNearVortex * kNearVortex) return true;
  return mayBeNearJump(spring, 1 + ab + bc + ca) &&
         isNearJump(distanceToJump(spring, triangle(a, b, c)));
}

namespace {

// The area is twice the angle of s = a + b in the tangent plane, for a nearly antipodal pair. So
// its gradient turns at |ds/dt| / |s|. The spring may give a speed of sqrt(k / m) |C| by the energy
// that it has.
void approachVortex(const SolidAngleSpring& spring, const MovingEnds<3>& ends, const Triangle& t,
                    Approach& result) {
  const auto& p = ends.points;
  std::array<double, 3> distances;
  for (std::size_t i = 0; i < 3; ++i) distances[i] = (p[i] + p[(i + 1) % 3]).norm();
  for (int time = 0; time < ends.times; ++time) {
    double turning = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double speed = (ends.velocity(time, i) + ends.velocity(time, (i + 1) % 3)).norm();
      turning += rate(speed, distances[i]);
    }
    result.turning = std::max(result.turning, turning);
  }
  result.distance = *std::min_element(distances.begin(), distances.end());
  const double frequency = 2 * std::sqrt(spring.stiffness * ends.largest_inverse_mass);
  result.falling = rate(std::sqrt(kPi) * frequency, result.distance);
  result.pull = rate(std::abs(conditionValue(spring, t)) * frequency, result.distance);
  result.place = "antipodal vertices";
}

// The area changes at 2 Im(z' / z).
double closingOfJump(const MovingEnds<3>& ends, const Triangle& t, double distance) {
  std::array<Vector3, 3> by_point;  // derivative of |z|^2 times the area's half
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3 &next = ends.points[(i + 1) % 3], &last = ends.points[(i + 2) % 3];
    by_point[i] =
        t.denominator * crossOfUnits(next, last) - t.triple_product * sumOfUnits(next, last);
  }
  double fastest = 0;
  for (int time = 0; time < ends.times; ++time) {
    double turn = 0;
    for (std::size_t i = 0; i < 3; ++i) turn += ends.velocity(time, i).dot(by_point[i]);
    fastest = std::max(fastest, std::abs(turn));
  }
  return closingRate(rate(2 * fastest, t.squared_norm), distance);
}

}  // namespace

Approach approach(const SolidAngleSpring& spring, const MovingEnds<3>& ends) {
  const auto& [a, b, c] = ends.points;
  const Triangle t = triangle(a, b, c);
  Approach result;
  const double to_jump = distanceToJump(spring, t);
  if (isNearJump(to_jump)) {
    result.distance = to_jump;
    result.place = "the jump of its area";
    result.closing = closingOfJump(ends, t, to_jump);
  }
  if (t.squared_norm < kNearVortex * kNearVortex) approachVortex(spring, ends, t, result);
  return result;
}

bool isNear(const OrientedAngleSpring& spring, const std::array<Vector3, 3>& points) {
  const auto& [a, b, c] = points;
  return isPairNear(std::abs(spring.rest_angle), a, b) ||
         std::abs(a.dot(b.cross(c))) <= kNearSign * effectiveWidth(spring);
}

Approach approach(const OrientedAngleSpring& spring, const MovingEnds<3>& ends) {
  constexpr double kSteepest = 15. / 8;
  const auto& p = ends.points;
  Approach result = approachOfPair(std::abs(spring.rest_angle), ends);
  const double width = effectiveWidth(spring);
  const double distance = std::abs(tripleProduct(p[0], p[1], p[2]));
  if (width == 0 || distance > kNearSign * width) return result;
  double fastest = 0;
  for (int time = 0; time < ends.times; ++time) {
    double speed = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      speed += ends.velocity(time, i).dot(crossOfUnits(p[(i + 1) % 3], p[(i + 2) % 3]));
    }
    fastest = std::max(fastest, std::abs(speed));
  }
  const double bend = kSteepest * arc(p[0], p[1]).angle / width;
  result.turning = fastest / width;
  result.falling = bend * std::sqrt(spring.stiffness * ends.largest_inverse_mass);
  result.pull = result.falling;
  if (result.closing == 0) {
    result.distance = distance;
    result.place = "its change of sign";
  }
  return result;
}

}  // namespace spherical_springs::core
