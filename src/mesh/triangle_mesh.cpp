#include "spherical_springs/mesh/triangle_mesh.h"

namespace spherical_springs::mesh {

Eigen::VectorXd faceAreas(const TriangleMesh& mesh) {
  Eigen::VectorXd areas(mesh.faces.cols());
  for (Eigen::Index f = 0; f < areas.size(); ++f) {
    const Vector3 a = mesh.vertices.col(mesh.faces(0, f));
    const Vector3 ab = mesh.vertices.col(mesh.faces(1, f)) - a;
    const Vector3 ac = mesh.vertices.col(mesh.faces(2, f)) - a;
    areas[f] = 0.5 * ab.cross(ac).norm();
  }
  return areas;
}

}  // namespace spherical_springs::mesh
