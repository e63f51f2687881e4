// Triangle meshes.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "spherical_springs/sphere.h"

namespace spherical_springs::mesh {

using core::Points;
using core::Vector3;

/// One column a face: the indices of its vertices, counter-clockwise seen from outside.
using Faces = Eigen::Matrix<std::int32_t, 3, Eigen::Dynamic>;

struct TriangleMesh {
  Points vertices;  ///< [m]
  Faces faces;
};

/// One a face [m^2].
Eigen::VectorXd faceAreas(const TriangleMesh& mesh);

/// Of a closed mesh, negative where its faces look inwards [m^3].
double volume(const TriangleMesh& mesh);

}  // namespace spherical_springs::mesh
