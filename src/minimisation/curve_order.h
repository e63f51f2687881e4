#pragma once

#include <cstdint>
#include <vector>

#include "spherical_springs/sphere.h"

namespace spherical_springs::core {

/// The points numbered along a space-filling curve, so that neighbours on the sphere are mostly
/// neighbours in number: their indices in that order.
std::vector<std::uint32_t> curveOrder(const Points& points);

}  // namespace spherical_springs::core
