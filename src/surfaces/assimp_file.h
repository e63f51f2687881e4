// PLY, STL and OFF files, by the Open Asset Import Library.
#pragma once

#include <filesystem>

#include "surfaces/polygon_mesh.h"

namespace spherical_springs::mesh {

/// Reads a file that its ending says is PLY, STL or OFF. Coordinates are rounded to single
/// precision. Corners of an STL file's facets become vertices of their own.
/// @param numbers_vertices whether the format tells vertices apart by numbers: not STL
/// @throw std::invalid_argument with the reason for a file of no faces, or one that is no such
/// file, or has a coordinate that is not finite or a corner that is no vertex.
PolygonMesh readByAssimp(const std::filesystem::path& path, bool numbers_vertices);

}  // namespace spherical_springs::mesh
