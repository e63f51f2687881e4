// Where a map of a surface lies on the sphere.
#pragma once

#include <optional>

#include "spherical_springs/maps/triangle_mesh.h"

namespace spherical_springs::mesh {

/// Directions from the middle of a surface, of any length but 0.
struct Placement {
  std::optional<Vector3> pole, front;
};

/// @throw std::invalid_argument where one vertex of the surface is the farthest in both directions.
void requireTwoVertices(const TriangleMesh& surface, const Placement& placement);

/// Turns a map so that the vertex of the surface that is farthest in the direction `pole` comes to
/// lie at z, and the one farthest in the direction `front` on the meridian of x, or at x itself
/// where there is no pole. What is left open turns as little as it can: also `front`, where the map
/// puts its vertex opposite the one at the pole.
/// @param sphere one unit vector a vertex
Points placed(const TriangleMesh& surface, const Points& sphere, const Placement& placement);

}  // namespace spherical_springs::mesh
