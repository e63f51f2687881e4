// What a command line asks for, read and checked.
#pragma once

#include <optional>

#include "options.h"
#include "spherical_springs/mesh/triangle_mesh.h"

namespace spherical_springs::relax_mesh {

using core::Points;

struct Task {
  mesh::TriangleMesh surface;
  Eigen::VectorXd shares;       ///< of the sphere, one a face, summing to 4 pi [sr]
  std::optional<Points> start;  ///< one unit vector a vertex
};

/// @throw std::invalid_argument or std::runtime_error, with the file and the reason, for a surface
/// that is no topological sphere or has no area, for densities that are not one a face, and for a
/// start that has other faces than the surface or a vertex without direction.
Task readTask(const Options& options);

}  // namespace spherical_springs::relax_mesh
