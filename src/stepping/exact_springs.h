// Springs of elements as their own formulas have them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "spherical_springs/springs/kinds.h"
#include "stepping/plain_springs.h"

namespace spherical_springs::core {

/// A width in use, 0 for a sharp step, as `OrientedAngleSpring` has it: there 0 is the default.
inline double widthOfSpring(double width) {
  return std::max(width, std::numeric_limits<double>::min());
}

/// Rows of a patch where the ends of an element are.
template <std::size_t N, class Group>
std::array<std::uint32_t, N> rowsOf(const Group& group, std::uint32_t lane, int first_end = 0) {
  std::array<std::uint32_t, N> rows;
  for (std::size_t i = 0; i < N; ++i) {
    rows[i] = static_cast<std::uint32_t>(group.ends[first_end + i][lane] / kRowLength);
  }
  return rows;
}

template <std::size_t N>
std::array<Vector3, N> pointsAt(const std::array<std::uint32_t, N>& rows, const Row* positions) {
  std::array<Vector3, N> points;
  for (std::size_t i = 0; i < N; ++i) {
    points[i] = Eigen::Map<const Vector3>(positions[rows[i]].values);
  }
  return points;
}

/// Returns the forces of a spring on its ends; what of a force is along the position means nothing.
template <class Spring>
std::array<Vector3, Spring::kParticles> forcesOf(
    const Spring& spring, const std::array<Vector3, Spring::kParticles>& points) {
  const auto c = condition(spring, points);
  std::array<Vector3, Spring::kParticles> forces;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3 torque = -spring.stiffness * c.value * c.gradient[i];
    forces[i] = torque.cross(points[i]);
  }
  return forces;
}

/// Calls `visit(spring, rows of its ends)` for each spring of an element.
template <int kEnds, int kSprings, class Visitor>
void forEachSpring(const ElementGroup<kEnds, kSprings>& group, std::uint32_t lane,
                   const Visitor& visit) {
  if constexpr (kEnds == 3) {
    SolidAngleSpring triangle;
    triangle.rest_solid_angle = group.springs[0].rest[lane];
    triangle.stiffness = group.springs[0].stiffness[lane];
    visit(triangle, rowsOf<3>(group, lane));
  }
  constexpr int kFirstArc = kEnds - 2;
  for (int i = kFirstArc; i < kSprings; ++i) {
    AngleSpring arc;
    arc.rest_angle = group.springs[i].rest[lane];
    arc.stiffness = group.springs[i].stiffness[lane];
    visit(arc, rowsOf<2>(group, lane, i - kFirstArc));
  }
}

template <class Visitor>
void forEachSpring(const OrientedArcs& group, std::uint32_t lane, const Visitor& visit) {
  OrientedAngleSpring spring;
  spring.rest_angle = group.springs[0].rest[lane];
  spring.stiffness = group.springs[0].stiffness[lane];
  spring.width = widthOfSpring(group.width[lane]);
  visit(spring, rowsOf<3>(group, lane));
}

template <class Spring, class Visitor>
void forEachSpring(const PlainSprings<Spring>& group, std::uint32_t lane, const Visitor& visit) {
  visit(group.springs[lane], rowsOf<Spring::kParticles>(group, lane));
}

}  // namespace spherical_springs::core
