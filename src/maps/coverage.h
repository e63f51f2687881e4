// Whether faces on the sphere cover it once, without a fold.
#pragma once

#include "spherical_springs/maps/triangle_mesh.h"

namespace spherical_springs::mesh {

/// Whether the corners of a face are counter-clockwise from outside beyond any doubt that rounding
/// leaves.
bool surelyPositive(const Vector3& a, const Vector3& b, const Vector3& c);

/// Whether every face of a closed mesh is surely positive and their areas sum to 4 pi: then the map
/// is one to one. Positive faces alone may cover the sphere several times.
bool coversOnce(const Faces& faces, const Points& points);

/// Standard deviation of log (area / share) of faces that are all positive. Takes no memory.
double spreadOf(const Faces& faces, const Eigen::VectorXd& shares, const Points& points);

}  // namespace spherical_springs::mesh
