#include "spherical_springs/maps/distortion.h"

#include <cmath>
#include <limits>
#include <stdexcept>

namespace spherical_springs::mesh {
namespace {

Vector3 cornerAngles(const Vector3& a, const Vector3& b, const Vector3& c) {
  const auto between = [](const Vector3& u, const Vector3& v) {
    return std::atan2(u.cross(v).norm(), u.dot(v));
  };
  return {between(b - a, c - a), between(c - b, a - b), between(a - c, b - c)};
}

double logRatio(double area, double share) {
  return std::log(std::max(std::abs(area), std::numeric_limits<double>::min()) / share);
}

void requireFittingSizes(const TriangleMesh& mesh, const ValuesRef& shares, const Points& map) {
  if (shares.size() != mesh.faces.cols()) {
    throw std::invalid_argument("there are " + std::to_string(shares.size()) + " shares for " +
                                std::to_string(mesh.faces.cols()) + " faces");
  }
  if (map.cols() != mesh.vertices.cols()) {
    throw std::invalid_argument("the map has " + std::to_string(map.cols()) +
                                " vertices; the mesh has " + std::to_string(mesh.vertices.cols()));
  }
}

}  // namespace

FaceDistortion faceDistortion(const TriangleMesh& mesh, const ValuesRef& shares,
                              const Points& map) {
  requireFittingSizes(mesh, shares, map);
  const Eigen::Index count = mesh.faces.cols();
  FaceDistortion result{Values(count), Values(count), Points(3, count)};
  for (Eigen::Index f = 0; f < count; ++f) {
    const auto angles = [&, face = mesh.faces.col(f)](const Points& places) {
      return cornerAngles(places.col(face[0]), places.col(face[1]), places.col(face[2]));
    };
    const auto face = mesh.faces.col(f);
    result.areas[f] = core::solidAngle(map.col(face[0]), map.col(face[1]), map.col(face[2]));
    result.log_area_ratios[f] = logRatio(result.areas[f], shares[f]);
    result.angle_changes.col(f) = angles(map) - angles(mesh.vertices);
  }
  return result;
}

Distortion summary(const FaceDistortion& faces) {
  const auto ratios = faces.log_area_ratios.array();
  const auto angles = faces.angle_changes.array().abs();
  Distortion result;
  result.spread = std::sqrt((ratios - ratios.mean()).square().mean());
  result.mean = ratios.abs().mean();
  result.worst = ratios.abs().maxCoeff();
  result.folded = (faces.areas.array() <= 0).count();
  result.total_area = faces.areas.sum();
  result.mean_angle = angles.mean();
  result.worst_angle = angles.maxCoeff();
  return result;
}

}  // namespace spherical_springs::mesh
