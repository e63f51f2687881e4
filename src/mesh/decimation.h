// Coarser and coarser meshes of the same sphere, and the way back.
#pragma once

#include <cstdint>
#include <vector>

#include "spherical_springs/mesh/triangle_mesh.h"

namespace spherical_springs::mesh {

/// A mesh whose vertices are the first of all, and the wanted area of each of its faces.
struct MeshLevel {
  std::int32_t vertex_count;
  Faces faces;
  Eigen::VectorXd shares;
};

/// Vertices are taken away one by one, each by moving it along an edge onto a neighbour, those of
/// small shares first; H. Hoppe, "Progressive meshes", SIGGRAPH 1996. Here they are numbered from
/// the last one taken away to the first; a face that vanishes leaves its share to the next.
struct Decimation {
  std::vector<std::int32_t> vertices;  ///< of the mesh, by number here
  /// Of each vertex, when it was taken away: the neighbours, counter-clockwise, from the one that
  /// it was moved to; none of vertices that stay.
  std::vector<std::vector<std::int32_t>> rings;
  std::vector<MeshLevel> levels;  ///< from the coarsest to the mesh itself
};

/// Levels with about a third of the vertices of the next, down to about `coarsest`.
Decimation decimation(const Faces& faces, const Eigen::VectorXd& shares, std::int32_t vertices,
                      std::int32_t coarsest);

/// Puts vertex `ring.size()` ...
/// A place for a vertex inside its ring, whose vertices are on the sphere and make positive faces
/// with the first of them: so that all its own faces are positive.
Vector3 placeInside(const std::vector<std::int32_t>& ring, const Points& points);

}  // namespace spherical_springs::mesh
