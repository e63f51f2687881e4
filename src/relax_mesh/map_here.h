// The map of a mesh, computed in this process.
#pragma once

#include "relax_mesh/options.h"
#include "relax_mesh/task.h"
#include "spherical_springs/maps/mesh_map.h"

namespace spherical_springs::relax_mesh {

/// Shows how far it has come. After a signal it ends with the best map so far.
/// @throw Interrupted after a signal where there is no map yet; what `mesh::meshMap` throws.
mesh::MeshMap mapHere(const Task& task, const Options& asked);

}  // namespace spherical_springs::relax_mesh
