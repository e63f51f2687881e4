// A map of a mesh to the sphere that cannot fold.
#pragma once

#include "maps/half_edges.h"

namespace spherical_springs::mesh {

/// The mesh with one face cut in three by a vertex of its own, the last; they come last, too, and
/// the face that is cut is the first of them.
struct FoldFreeStart {
  Faces faces;
  Eigen::VectorXd shares;
  Points points;
};

/// A drawing of the mesh without the face `cut`, in which every vertex lies in the barycentre of
/// the shares of the three regions that its paths to the corners cut out (S. Felsner and F.
/// Zickfeld, "Schnyder woods and orthogonal surfaces", 2008, for weights that differ), lifted to
/// the sphere by central projection of three corners of a regular tetrahedron; the fourth is the
/// new vertex. In linear time, and without a fold after rounding, see `kTotal` in the source.
FoldFreeStart foldFreeStart(const Faces& faces, const HalfEdges& edges, std::size_t vertices,
                            const Eigen::VectorXd& shares, Eigen::Index cut);

}  // namespace spherical_springs::mesh
