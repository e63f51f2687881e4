// Surfaces with texture coordinates.
#pragma once

#include "spherical_springs/maps/triangle_mesh.h"
#include "surfaces/projection.h"

namespace spherical_springs::mesh {

/// A surface with a place in a texture for each corner of each face.
struct TexturedSurface {
  TriangleMesh surface;
  Eigen::Matrix2Xd places;  ///< (u, v), one column each
  Faces corners;            ///< one column a face: the indices of its corners' places
};

/// Gives a surface the texture coordinates of a projection of its map. Faces that cross a seam or
/// have a pole inside are cut there, so that no face is wider than its part of the texture; the
/// vertices of the surface come first, in their order. A corner on a pole has a place in each face,
/// halfway between the other two.
/// @param sphere one unit vector a vertex
TexturedSurface textured(const TriangleMesh& surface, const Points& sphere, Projection projection);

/// Returns the standard deviation, over the area of the surface, of the logarithms of texture area
/// over surface area. 0: all parts of the surface get the same number of texels for their area.
double spreadOfTexelDensity(const TexturedSurface& textured);

}  // namespace spherical_springs::mesh
