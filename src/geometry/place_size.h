// How large a `TangentPlace` is, for kernels, which know no type of Eigen.
#pragma once

#include <cstddef>

namespace spherical_springs::core {

/// Numbers of a place in memory: tangent vectors x and y, the unit vector, and one that pads.
inline constexpr std::size_t kPlaceSize = 10;

}  // namespace spherical_springs::core
