// Connected pieces and holes of triangle meshes.
#pragma once

#include <cstdint>
#include <vector>

#include "maps/half_edges.h"

namespace spherical_springs::mesh {

/// Pieces of a mesh: two faces belong to the same piece where a chain of faces that share edges
/// leads from one to the other.
struct Pieces {
  std::vector<std::int32_t> of_face;  ///< the number of each face's piece, from 0
  std::vector<std::int32_t> sizes;    ///< the number of faces of each piece
};

/// Numbers the pieces in the order of their first faces. An edge may have any number of faces.
Pieces piecesOf(const Faces& faces);

/// The half-edges round one hole, each beginning where the one before ends.
using Hole = std::vector<HalfEdges::Index>;

/// Finds all holes of a mesh. Where parts of the surface meet in a vertex alone, the holes between
/// them are those whose filling joins the parts there.
std::vector<Hole> holesOf(const HalfEdges& edges);

}  // namespace spherical_springs::mesh
