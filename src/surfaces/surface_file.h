// Surfaces from files of several formats.
#pragma once

#include <filesystem>

#include "base/checkpoint.h"
#include "surfaces/polygon_mesh.h"

namespace spherical_springs::mesh {

/// Reads PLY, STL and OFF files, which the ending of their name tells (.ply, .stl, .off, in letters
/// of either case), and any other file as OBJ.
/// @throw std::invalid_argument or std::runtime_error with the file's name and the reason, for one
/// that cannot be read or is not of its format.
PolygonMesh readPolygons(const std::filesystem::path& path,
                         const core::Checkpoint& checkpoint = core::passAll);

}  // namespace spherical_springs::mesh
