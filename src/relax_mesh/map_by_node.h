// The map of a mesh, by the action of a node.
#pragma once

#include "relax_mesh/options.h"
#include "relax_mesh/task.h"
#include "spherical_springs/maps/mesh_map.h"

namespace spherical_springs::relax_mesh {

/// Shows how far the node has come, and prints what it answers. After a signal it has the node end
/// with the best map so far. ROS must have been initialised.
/// @throw Interrupted after a signal where there is no map yet; std::runtime_error where no master
/// or node answers, where the node ends, hangs or refuses, with its reason, and for an answer that
/// is no map.
mesh::MeshMap mapByNode(const Task& task, const Options& options);

}  // namespace spherical_springs::relax_mesh
