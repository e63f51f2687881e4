// Projections of the sphere to the square of texture coordinates.
#pragma once

#include <array>
#include <string>

#include "spherical_springs/maps/triangle_mesh.h"

namespace spherical_springs::mesh {

/// Projections to (u, v), each from 0 to 1. The first two show longitude as u = 1/2 + longitude /
/// (2 pi), 0 at x and 90 degrees at y, with a seam at 180 degrees. By `longitude_latitude` v = 1/2
/// + latitude / pi. By `equal_area_cylinder`, Lambert's, v = (1 + z) / 2. By
/// `equal_area_octahedron` the northern half is the square of the middle between (1/2, 0) and (0,
/// 1/2), the south pole is at all four corners, and seams go along the meridians 0, 90, 180 and 270
/// degrees of the southern half (Clarberg, "Fast equal-area mapping of the (hemi)sphere using
/// SIMD", 2008).
enum class Projection { longitude_latitude, equal_area_cylinder, equal_area_octahedron };

/// @throw std::invalid_argument for another name than longitude-latitude, equal-area-cylinder or
/// equal-area-octahedron.
Projection projection(const std::string& name);

/// The side of each coordinate plane, 1 or -1, on which a part of the sphere lies. Points in such a
/// plane, as on a seam, have a place for each side.
using Side = std::array<int, 3>;

/// Returns the place of a unit vector.
Eigen::Vector2d placeOf(Projection projection, const Vector3& direction, const Side& side);

}  // namespace spherical_springs::mesh
