#pragma once

#include <spherical_springs/MapMeshGoal.h>

#include <optional>

#include "spherical_springs/maps/sphere_map.h"

namespace spherical_springs {

/// A goal of ~map_mesh, read.
struct MeshGoal {
  mesh::TriangleMesh mesh;
  core::Values shares;                ///< of the sphere, one a face [sr]
  std::optional<core::Points> start;  ///< one unit vector a vertex
  mesh::MapOptions options;           ///< tolerance, time and angle weight of the goal
};

/// Reads a goal; of the mesh it sees to what the numbers are, and not to how they hang together.
/// @throw std::invalid_argument that names the field, its value and what is allowed.
MeshGoal meshGoalFrom(const MapMeshGoal& message);

}  // namespace spherical_springs
