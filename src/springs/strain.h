// How far a spring of any kind is from rest, as one number that can be compared between kinds.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "spherical_springs/sphere.h"
#include "spherical_springs/springs/condition.h"

namespace spherical_springs::core {

/// The difference between the present value of the spring's measure (an angle or solid angle) and
/// the one at rest, as a share of the larger of the two, from -1 to 1: 1/2 where it is twice what
/// it should be, -1/2 where it is half, -1 where nothing is left of it or its sign is the wrong
/// one. Positive is larger than at rest, whatever the sign of the measure; 0 where both are 0.
template <class Spring>
double strain(const Spring& spring, const std::array<Vector3, Spring::kParticles>& points) {
  const double rest = spring.restValue();
  const double difference = condition(spring, points).value;
  const double larger = std::max(std::abs(rest), std::abs(rest + difference));
  if (larger == 0) return 0;
  return std::clamp((rest < 0 ? -difference : difference) / larger, -1., 1.);
}

}  // namespace spherical_springs::core
