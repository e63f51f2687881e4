// The files that a command line asks for.
#pragma once

#include <Eigen/Core>
#include <string>

#include "relax_mesh/options.h"
#include "relax_mesh/task.h"
#include "spherical_springs/maps/distortion.h"
#include "spherical_springs/maps/triangle_mesh.h"
#include "surfaces/texture_coordinates.h"

namespace spherical_springs::relax_mesh {

/// Returns the surface with the texture coordinates that the options ask for.
mesh::TexturedSurface textureOf(const Options& options, const Task& task, const Points& map);

/// Writes every file that can be written, each whole. A first signal does not stop it.
/// @return their names, as a list in words.
/// @throw std::runtime_error, after that, with the reasons why some could not, and the names of
/// those that have been.
std::string writeFiles(const Options& options, const Task& task, const Points& map,
                       const mesh::FaceDistortion& faces);

}  // namespace spherical_springs::relax_mesh
