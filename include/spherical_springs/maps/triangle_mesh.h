// Triangle meshes.
#pragma once

#include <cstdint>

#include "spherical_springs/sphere.h"

/// Maps of closed meshes to the sphere.
namespace spherical_springs::mesh {

using core::Points;
using core::Values;
using core::ValuesRef;
using core::Vector3;

/// One column a face: the indices of its vertices, counter-clockwise seen from outside.
using Faces = core::Unaligned<std::int32_t, 3, Eigen::Dynamic>;

/// Vertices and the triangles between them.
struct TriangleMesh {
  Points vertices;  ///< [m]
  Faces faces;      ///< by indices of vertices
};

/// One a face [m^2].
Values faceAreas(const TriangleMesh& mesh);

/// Volume of a closed mesh [m^3], negative where its faces look inwards.
double volume(const TriangleMesh& mesh);

}  // namespace spherical_springs::mesh
