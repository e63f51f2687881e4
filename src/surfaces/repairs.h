// Repairs of surfaces.
#pragma once

#include <string>
#include <vector>

#include "surfaces/surface.h"

namespace spherical_springs::mesh {

/// Repairs that a person has asked for.
struct Repairs {
  bool weld = false;           ///< whether vertices on one spot become one
  bool largest_piece = false;  ///< whether to keep only the piece of the largest area
  int longest_hole = 0;        ///< holes of up to so many edges are filled; 0: none
};

/// Repairs a surface. Vertices of no face are always left out. Then, as asked for, vertices are
/// welded and faces that have one vertex twice after that left out; all pieces but the largest left
/// out; and holes filled, one of three edges by a triangle, others by triangles round a new vertex
/// in their middle.
/// @return a sentence for each kind of repair that changed something.
/// @throw std::invalid_argument, in the words of `names`, where holes are to be filled and an edge
/// has more than two faces, or two that turn opposite ways.
std::vector<std::string> repair(Surface& surface, const Repairs& repairs, const MeshNames& names);

/// Whether two vertices have the same coordinates.
bool hasVerticesOnOneSpot(const Surface& surface);

}  // namespace spherical_springs::mesh
