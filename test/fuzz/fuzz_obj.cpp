// OBJ files of any bytes: refused, or meshes that are written and read back the same; those that
// are topological spheres have maps without folds and texture coordinates.
#include <cmath>
#include <cstdint>
#include <functional>
#include <sstream>
#include <stdexcept>
#include <string>

#include "maps/topological_sphere.h"
#include "soundness.h"
#include "spherical_springs/maps/distortion.h"
#include "spherical_springs/maps/sphere_map.h"
#include "surfaces/obj_file.h"
#include "surfaces/surface.h"

using namespace spherical_springs;  // NOLINT: a program, not a header
using core::fuzzing::require;

namespace {

mesh::TriangleMesh meshOf(const std::string& text) {
  std::istringstream in(text);
  return mesh::triangulated(mesh::readObj(in)).mesh;
}

void requireReadBackTheSame(const mesh::TriangleMesh& mesh) {
  std::ostringstream written;
  writeObj(written, mesh);
  const mesh::TriangleMesh again = meshOf(written.str());
  require(mesh.vertices == again.vertices, "vertices read back to the last bit");
  require(mesh.faces == again.faces, "faces read back");
}

/// Shares that differ much, as those of faces without area do, and maps evened out to the end take
/// a hundred times as long. One mesh of sixty-four is mapped so.
struct Effort {
  double steepest;  ///< the largest share, of the smallest
  int iterations;   ///< and no time, which would make less of a case on a slower machine
};

Effort effortFor(const std::string& text) {
  return std::hash<std::string>()(text) % 64 == 0 ? Effort{1e9, 100} : Effort{30, 8};
}

Eigen::VectorXd sharesOf(const mesh::TriangleMesh& surface, double steepest) {
  const Eigen::VectorXd shares = mesh::faceShares(mesh::faceAreas(surface));
  const Eigen::VectorXd near = shares.cwiseMax(shares.maxCoeff() / steepest);
  return near * (4 * core::kPi / near.sum());
}

void requireMapped(const mesh::TriangleMesh& surface, Effort effort) {
  const Eigen::VectorXd shares = sharesOf(surface, effort.steepest);
  mesh::MapOptions options;
  options.go_on = [&](const mesh::MapProgress&) { return --effort.iterations > 0; };
  const core::Points map = mesh::sphereMap(surface, shares, options);
  core::fuzzing::requireUnitVectors(map);
  const mesh::Distortion distortion = summary(faceDistortion(surface, shares, map));
  require(distortion.folded == 0, "no face is folded");
  require(std::abs(distortion.total_area - 4 * core::kPi) < 1e-9, "the sphere is covered once");
  require(std::isfinite(distortion.spread + distortion.worst_angle), "distortion is finite");
  for (const auto projection :
       {mesh::Projection::longitude_latitude, mesh::Projection::equal_area_octahedron}) {
    const mesh::TexturedSurface texture = mesh::textured(surface, map, projection);
    require(texture.places.allFinite(), "texture coordinates are finite");
    require(texture.places.minCoeff() >= 0 && texture.places.maxCoeff() <= 1,
            "texture coordinates are in the texture");
    require(texture.corners.minCoeff() >= 0 && texture.corners.maxCoeff() < texture.places.cols(),
            "corners have texture coordinates");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(data, data + size);
  mesh::TriangleMesh mesh;
  try {
    mesh = meshOf(text);
  } catch (const std::invalid_argument&) {
    return 0;
  }
  require(mesh.vertices.allFinite(), "vertices are finite");
  require(mesh.faces.minCoeff() >= 0 && mesh.faces.maxCoeff() < mesh.vertices.cols(),
          "corners are vertices");
  requireReadBackTheSame(mesh);
  try {
    requireTopologicalSphere(mesh);
    requireMapped(mesh, effortFor(text));
  } catch (const std::invalid_argument&) {
  }
  return 0;
}
