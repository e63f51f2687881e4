#include "spherical_springs/maps/triangle_mesh.h"

namespace spherical_springs::mesh {

Values faceAreas(const TriangleMesh& mesh) {
  Values areas(mesh.faces.cols());
  for (Eigen::Index f = 0; f < areas.size(); ++f) {
    const Vector3 a = mesh.vertices.col(mesh.faces(0, f));
    const Vector3 ab = mesh.vertices.col(mesh.faces(1, f)) - a;
    const Vector3 ac = mesh.vertices.col(mesh.faces(2, f)) - a;
    areas[f] = 0.5 * ab.cross(ac).norm();
  }
  return areas;
}

double volume(const TriangleMesh& mesh) {
  const Vector3 middle = mesh.vertices.rowwise().mean();  // near to it products round least
  double six_times = 0;
  for (Eigen::Index f = 0; f < mesh.faces.cols(); ++f) {
    const Vector3 a = mesh.vertices.col(mesh.faces(0, f)) - middle;
    const Vector3 b = mesh.vertices.col(mesh.faces(1, f)) - middle;
    const Vector3 c = mesh.vertices.col(mesh.faces(2, f)) - middle;
    six_times += a.dot(b.cross(c));
  }
  return six_times / 6;
}

}  // namespace spherical_springs::mesh
