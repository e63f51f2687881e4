#pragma once

#include <cstdint>
#include <vector>

#include "spherical_springs/sphere.h"

namespace spherical_springs::core {

/// The points along a space-filling curve, so that neighbours on the sphere are mostly neighbours
/// in the order: their indices. It depends on the indices only where points coincide.
std::vector<std::uint32_t> curveOrder(const Points& points);

}  // namespace spherical_springs::core
