// How far a map of a mesh to the sphere is from keeping areas and angles.
#pragma once

#include "spherical_springs/maps/triangle_mesh.h"

namespace spherical_springs::mesh {

/// One entry, or one column, a face.
struct FaceDistortion {
  Values areas;            ///< on the sphere, negative where the face is folded over [sr]
  Values log_area_ratios;  ///< log(|area| / share), finite
  Points angle_changes;    ///< corner angles, flat, on the sphere minus those on the surface [rad]
};

/// Distortion of a map, one unit vector a vertex. `shares` [sr] are the areas wanted for the faces:
/// one a face, positive, summing to 4 pi. Angles are those of the flat triangles with the same
/// corners, on both sides, as in the literature on conformal maps (Choi, Lam, Lui 2015,
/// doi:10.1137/130950008). A triangle with two vertices on one spot has an angle of 0 there.
/// @throw std::invalid_argument where the sizes do not fit.
FaceDistortion faceDistortion(const TriangleMesh& mesh, const ValuesRef& shares, const Points& map);

/// Summary of the distortion of a map.
struct Distortion {
  double spread = 0;        ///< standard deviation of the log area ratios
  double mean = 0;          ///< of their magnitudes
  double worst = 0;         ///< the largest magnitude
  Eigen::Index folded = 0;  ///< faces of no area, or folded over
  double total_area = 0;    ///< signed; 4 pi where the sphere is covered once [sr]
  double mean_angle = 0;    ///< of the magnitudes of the changes of corner angles [rad]
  double worst_angle = 0;   ///< the largest [rad]
};

/// Summarises the distortion of one face or more.
/// \snippet test_headers.cpp map
Distortion summary(const FaceDistortion& faces);

}  // namespace spherical_springs::mesh
