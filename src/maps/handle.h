// Handles of closed surfaces.
#pragma once

#include <vector>

#include "maps/half_edges.h"

namespace spherical_springs::mesh {

/// Finds a short closed path of edges that does not part the surface: it runs round a handle or
/// through it. By a spanning tree of vertices and one of faces that does not cross it, as Eppstein
/// ("Dynamic generators of topologically embedded graphs", SODA 2003) has it.
/// @param edges of a closed, manifold mesh of one piece, of genus 1 or above
/// @return the vertices of the path in order.
std::vector<HalfEdges::Index> pathRoundAHandle(const HalfEdges& edges);

}  // namespace spherical_springs::mesh
