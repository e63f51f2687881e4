#include "relax_mesh/task.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "base/files.h"
#include "maps/topological_sphere.h"
#include "relax_mesh/interruption.h"
#include "spherical_springs/maps/mesh_map.h"
#include "surfaces/face_files.h"
#include "surfaces/repairs.h"
#include "surfaces/surface.h"
#include "surfaces/surface_file.h"

namespace spherical_springs::relax_mesh {
namespace {

namespace fs = std::filesystem;

/// A surface, and the file that it comes from.
struct Source {
  explicit Source(const fs::path& path)
      : file(mesh::readPolygons(path, throwIfInterrupted)),
        surface(mesh::triangulated(file)),
        names(file, surface) {}
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;

  mesh::PolygonMesh file;
  mesh::Surface surface;
  mesh::FileNames names;
};

/// Repairs the surface. Returns what was done.
std::vector<std::string> repair(const Options& options, Source& source) {
  mesh::Repairs repairs = options.repairs;
  repairs.weld |= !source.file.numbers_vertices;
  return about(options.mesh, [&] {
    std::vector<std::string> told = mesh::repair(source.surface, repairs, source.names);
    mesh::requireTopologicalSphere(source.surface.mesh, source.names);
    return told;
  });
}

/// Returns a density a triangle: the one of its face in the file, and for faces that fill holes the
/// mean of all.
Values densitiesOfTriangles(const Values& densities, const mesh::Surface& surface) {
  Values result(surface.mesh.faces.cols());
  for (Eigen::Index f = 0; f < result.size(); ++f) {
    const std::int32_t face = surface.file_faces[f];
    result[f] = face == mesh::Surface::kNone ? densities.mean() : densities[face];
  }
  return result;
}

void readShares(const Options& options, const Source& source, Task& task) {
  const Values areas = mesh::faceAreas(source.surface.mesh);
  task.shares_from = options.mesh;
  task.shares = about(options.mesh, [&] { return mesh::faceShares(areas); });
  if (options.density.empty()) return;
  task.shares_from = options.density;
  std::ifstream in = core::openToRead(options.density);
  about(options.density, [&] {
    const Values densities = mesh::readDensities(in, source.file.faces(), throwIfInterrupted);
    task.density = densitiesOfTriangles(densities, source.surface);
    task.shares = mesh::faceShares(areas.cwiseProduct(task.density));
  });
}

Points directions(const Points& vertices, const mesh::MeshNames& names) {
  Points result(3, vertices.cols());
  for (std::int32_t i = 0; i < vertices.cols(); ++i) {
    if (vertices.col(i).isZero(0)) {
      throw std::invalid_argument(names.vertex(i) + " has no direction");
    }
    result.col(i) = core::direction(vertices.col(i));
  }
  return result;
}

/// Whether a start gives every vertex of the source's file its place, in the same faces.
bool isOfSameFile(const mesh::PolygonMesh& start, const Source& source) {
  const auto& of_file = source.surface.file_vertices;
  return start.corners == source.file.corners && start.ends == source.file.ends &&
         start.vertices.size() == source.file.vertices.size() &&
         std::find(of_file.begin(), of_file.end(), mesh::Surface::kNone) == of_file.end();
}

/// Reads a start with the faces of the file, or with those of the surface made of it.
Points readStart(const fs::path& path, const Source& source) {
  const Source start(path);
  return about(path, [&] {
    Points all = directions(start.surface.mesh.vertices, start.names);
    if (isOfSameFile(start.file, source)) {
      Points result(3, source.surface.mesh.vertices.cols());
      for (Eigen::Index v = 0; v < result.cols(); ++v) {
        result.col(v) = all.col(source.surface.file_vertices[v]);
      }
      return result;
    }
    const mesh::Faces &faces = start.surface.mesh.faces, &wanted = source.surface.mesh.faces;
    if (faces.cols() != wanted.cols() || faces != wanted ||
        all.cols() != source.surface.mesh.vertices.cols()) {
      throw std::invalid_argument("its faces are not those of the surface");
    }
    return all;
  });
}

}  // namespace

Task readTask(const Options& options) {
  Source source(options.mesh);
  Task task;
  task.repairs = repair(options, source);
  about(options.mesh, [&] { requireTwoVertices(source.surface.mesh, options.placement); });
  task.inside_out = mesh::volume(source.surface.mesh) < 0;
  readShares(options, source, task);
  if (!options.sphere.empty()) task.start = readStart(options.sphere, source);
  task.surface = std::move(source.surface.mesh);
  return task;
}

double timeFor(const Task& task, const Options& options) {
  return options.max_time.value_or(mesh::usualTime(task.surface.vertices.cols()));
}

}  // namespace spherical_springs::relax_mesh
