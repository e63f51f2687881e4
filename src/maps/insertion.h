#pragma once

#include <cstdint>
#include <vector>

#include "spherical_springs/maps/triangle_mesh.h"

namespace spherical_springs::mesh {

/// Returns a place for a vertex inside its ring at which all its faces are positive. The vertices
/// of the ring are on the sphere and make positive faces with the first of them.
Vector3 placeInside(const std::vector<std::int32_t>& ring, const Points& points);

}  // namespace spherical_springs::mesh
