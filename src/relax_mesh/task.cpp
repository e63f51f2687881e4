#include "relax_mesh/task.h"

#include <stdexcept>
#include <string>

#include "base/files.h"
#include "maps/topological_sphere.h"
#include "relax_mesh/face_files.h"
#include "relax_mesh/interruption.h"
#include "relax_mesh/obj_file.h"
#include "spherical_springs/maps/sphere_map.h"

namespace spherical_springs::relax_mesh {
namespace {

namespace fs = std::filesystem;

mesh::TriangleMesh readSurface(const fs::path& path) {
  mesh::TriangleMesh surface = mesh::readObj(path, throwIfInterrupted);
  about(path, [&] { mesh::requireTopologicalSphere(surface); });
  return surface;
}

Values readShares(const Options& options, const mesh::TriangleMesh& surface) {
  const Values areas = mesh::faceAreas(surface);
  Values shares = about(options.mesh, [&] { return mesh::faceShares(areas); });
  if (options.density.empty()) return shares;
  std::ifstream in = core::openToRead(options.density);
  return about(options.density, [&] {
    return mesh::faceShares(
        areas.cwiseProduct(mesh::readDensities(in, areas.size(), throwIfInterrupted)));
  });
}

Points directions(const Points& vertices) {
  Points result(3, vertices.cols());
  for (Eigen::Index i = 0; i < vertices.cols(); ++i) {
    if (vertices.col(i).isZero(0)) {
      throw std::invalid_argument("vertex " + std::to_string(i) +
                                  " is at the origin, and has no direction");
    }
    result.col(i) = core::direction(vertices.col(i));
  }
  return result;
}

Points readStart(const fs::path& path, const mesh::Faces& faces) {
  const mesh::TriangleMesh sphere = mesh::readObj(path, throwIfInterrupted);
  return about(path, [&] {
    if (sphere.faces.cols() != faces.cols() || sphere.faces != faces) {
      throw std::invalid_argument("its faces are not those of the surface");
    }
    return directions(sphere.vertices);
  });
}

}  // namespace

Task readTask(const Options& options) {
  Task task;
  task.surface = readSurface(options.mesh);
  task.inside_out = mesh::volume(task.surface) < 0;
  task.shares_from = options.density.empty() ? options.mesh : options.density;
  task.shares = readShares(options, task.surface);
  if (!options.sphere.empty()) task.start = readStart(options.sphere, task.surface.faces);
  return task;
}

}  // namespace spherical_springs::relax_mesh
