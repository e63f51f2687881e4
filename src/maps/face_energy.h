// The energy of one face of a map to the sphere.
#pragma once

#include <array>

#include "maps/face_options.h"
#include "spherical_springs/maps/triangle_mesh.h"
#include "spherical_springs/springs/condition.h"

namespace spherical_springs::mesh {

/// weight (cost of the area
///   + shape (tan^2(area / 4) + sum over edges of tan^2(edge / 2) / sqrt 3) / share),
/// infinite at a face of half of the sphere and at an edge of length pi, if there is a shape.
struct FaceEnergy {
  using Corners = std::array<Vector3, 3>;
  using Frames = std::array<core::TangentFrame, 3>;
  struct Terms {
    double value;
    Eigen::Matrix<double, 6, 1> gradient;
    Eigen::Matrix<double, 6, 6> hessian;
  };

  double share, weight, shape;
  AreaCost cost = AreaCost::barrier;

  /// With the barrier infinite where the corners are not clearly in the positive sense.
  double value(const Corners& corners) const {
    return value(corners, core::solidAngle(corners[0], corners[1], corners[2]));
  }
  double value(const Corners& corners, double area) const;  ///< the same, of a known area

  /// Value and derivatives by coordinates in the tangent frames of the corners.
  Terms terms(const Corners& corners, const Frames& frames, FaceHessian hessian) const;

 private:
  void addEdges(const Corners& corners, const Frames& frames, Terms& terms) const;
};

}  // namespace spherical_springs::mesh
