// Three trees that between them hold every inner edge of a triangulated disc.
#pragma once

#include <array>
#include <vector>

#include "maps/half_edges.h"

namespace spherical_springs::mesh {

/// W. Schnyder, "Embedding planar graphs on the grid", SODA 1990. The disc is a closed mesh of
/// genus 0 without one face; its three outer vertices are the roots of the trees.
struct SchnyderWood {
  using Index = HalfEdges::Index;

  std::array<Index, 3> roots;                 ///< counter-clockwise round the disc
  std::vector<std::array<Index, 3>> parents;  ///< of each vertex, in each tree; none of roots
  /// The vertex of each face that holds its angle of each label; none of the face without.
  std::vector<std::array<Index, 3>> corners;
  /// Vertices such that parents in tree 2 come before, in trees 0 and 1 after their children.
  std::vector<Index> order;
};

SchnyderWood schnyderWood(const HalfEdges& edges, std::size_t vertices, HalfEdges::Index without);

}  // namespace spherical_springs::mesh
