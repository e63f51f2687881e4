#pragma once

#include <cstdint>
#include <vector>

#include "spherical_springs/springs/kinds.h"

namespace spherical_springs::core {

template <class Spring>
struct SpringIndexList : std::vector<std::uint32_t> {};

/// Some springs of a system, as indices.
using SpringSubset = PerKind<SpringIndexList>;

}  // namespace spherical_springs::core
