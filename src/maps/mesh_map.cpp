#include "spherical_springs/maps/mesh_map.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace spherical_springs::mesh {

double usualTime(Eigen::Index vertices) { return std::max(17., 1.6e-3 * vertices); }

bool coversOnce(const Distortion& distortion) {
  constexpr double kRounding = 1e-6;
  return distortion.folded == 0 && std::abs(distortion.total_area - 4 * core::kPi) < kRounding;
}

Points centralProjection(const TriangleMesh& mesh) {
  const Vector3 mean = mesh.vertices.rowwise().mean();
  Points result(3, mesh.vertices.cols());
  for (Eigen::Index v = 0; v < mesh.vertices.cols(); ++v) {
    const Vector3 from_mean = mesh.vertices.col(v) - mean;
    result.col(v) = from_mean.isZero(0) ? Vector3::UnitZ() : core::direction(from_mean);
  }
  return result;
}

MeshMap meshMap(const TriangleMesh& mesh, const ValuesRef& shares,
                const std::optional<Points>& start, const MapOptions& options) {
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  MeshMap map;
  MapOptions watched = options;
  watched.go_on = [&](const MapProgress& progress) {
    const bool goes_on = options.go_on(progress);
    if (!goes_on) map.end = MapEnd::told;
    return goes_on;
  };
  watched.out_of_memory = [&] {
    map.end = MapEnd::no_memory;
    options.out_of_memory();
  };
  map.points = start ? sphereMap(mesh, shares, *start, watched) : sphereMap(mesh, shares, watched);
  const std::chrono::duration<double> elapsed = Clock::now() - begin;
  if (map.end == MapEnd::found && elapsed.count() >= options.max_time) map.end = MapEnd::time;
  map.faces = faceDistortion(mesh, shares, map.points);
  map.distortion = summary(map.faces);
  if (!coversOnce(map.distortion)) throw NoMap("the map that was found has folds");
  if (options.angle_weight == 0 && map.distortion.spread <= options.tolerance) {
    map.end = MapEnd::found;
  }
  return map;
}

}  // namespace spherical_springs::mesh
