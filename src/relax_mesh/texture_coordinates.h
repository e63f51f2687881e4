// A sphere's longitudes and latitudes as texture coordinates.
#pragma once

#include "spherical_springs/maps/triangle_mesh.h"

namespace spherical_springs::mesh {

struct TextureCoordinates {
  Eigen::Matrix2Xd places;  ///< (u, v), one column each
  Faces corners;            ///< one column a face: the indices of its corners' places
};

/// Maps unit vectors to u = 1/2 + longitude / (2 pi), v = 1/2 + latitude / pi; longitude 0 is at x,
/// 90 degrees at y, latitude 90 degrees at z. The first places are those of the vertices, in their
/// order. Corners of faces that lie across the seam at 180 degrees get places of their own beyond
/// u = 1, where a texture repeats. A corner on a pole gets one in each face, halfway between the
/// other two. A face with a pole inside has no picture in this chart, and is drawn over its
/// neighbours; there are two at most.
TextureCoordinates longitudeLatitude(const Points& sphere, const Faces& faces);

}  // namespace spherical_springs::mesh
