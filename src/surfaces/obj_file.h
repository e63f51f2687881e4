// Wavefront OBJ files: polygons are read, triangles written; vertices and faces keep their order.
#pragma once

#include <istream>
#include <ostream>

#include "base/checkpoint.h"
#include "surfaces/polygon_mesh.h"
#include "surfaces/texture_coordinates.h"

namespace spherical_springs::mesh {

/// Reads lines `v x y z` and `f a b c ...`, with corners as `1`, `1/2`, `1//3`, `1/2/3` or counted
/// back from the last vertex as `-1`. What else a vertex or a corner says, and every other line, is
/// passed over.
/// @throw std::invalid_argument, which names the line and what is allowed, for a vertex that is not
/// three finite numbers, a face that is not three vertices of the file or more, or a text that has
/// no vertices or no faces.
PolygonMesh readObj(std::istream& in, const core::Checkpoint& checkpoint = core::passAll);

/// Writes as many digits as give back every number to the last bit.
void writeObj(std::ostream& out, const TriangleMesh& mesh,
              const core::Checkpoint& checkpoint = core::passAll);

/// Writes texture coordinates besides.
void writeObj(std::ostream& out, const TexturedSurface& textured,
              const core::Checkpoint& checkpoint = core::passAll);

}  // namespace spherical_springs::mesh
