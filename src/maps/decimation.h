// Coarser and coarser meshes of the same sphere, and the way back.
#pragma once

#include <cstdint>
#include <vector>

#include "base/checkpoint.h"
#include "spherical_springs/maps/triangle_mesh.h"

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
  /// For each vertex the neighbours that it had when it was taken away, counter-clockwise, from the
  /// one that it was moved to; empty for vertices that stay.
  std::vector<std::vector<std::int32_t>> rings;
  std::vector<MeshLevel> levels;  ///< from the coarsest to the mesh itself
};

/// Makes levels with about a third of the vertices of the next, down to about `coarsest`, in
/// n log n time.
Decimation decimation(const Faces& faces, const Eigen::VectorXd& shares, std::int32_t vertices,
                      std::int32_t coarsest, const core::Checkpoint& checkpoint = core::passAll);

}  // namespace spherical_springs::mesh
