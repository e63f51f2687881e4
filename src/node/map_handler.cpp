#include "node/map_handler.h"

#include <chrono>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "base/rounded.h"
#include "node/faults.h"
#include "spherical_springs/maps/map_scene.h"

namespace spherical_springs {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kLoaded = "; the map is the scene";

void requireRoom(const core::SceneLimits& limits, const mesh::TriangleMesh& mesh) {
  const auto require = [](std::size_t needed, std::size_t allowed, const char* items,
                          const char* parameter) {
    if (needed <= allowed) return;
    throw std::invalid_argument("load: the map needs " + std::to_string(needed) + " " + items +
                                "; allowed here, by " + parameter + ": at most " +
                                std::to_string(allowed));
  };
  require(mesh.vertices.cols(), limits.particles, "particles", "~max_particles");
  require(mesh::springCountOfMap(mesh.faces.cols()), limits.springs, "springs", "~max_springs");
}

std::string wordsFor(const mesh::MeshMap& map, const mesh::MapOptions& options) {
  const std::string spread = "spread " + core::roundedText(map.distortion.spread);
  switch (map.end) {
    case mesh::MapEnd::found:
      return (options.angle_weight > 0 || map.distortion.spread <= options.tolerance
                  ? "mapped; "
                  : "mapped; nothing better was found; ") +
             spread;
    case mesh::MapEnd::time:
      return "max_time is over; best map so far: " + spread;
    case mesh::MapEnd::told:
      return "cancelled; best map so far: " + spread;
    case mesh::MapEnd::no_memory:
      return "there is not enough memory to improve the map further; best map so far: " + spread;
  }
  return "";
}

void write(const mesh::MeshMap& map, MapMeshResult& result) {
  result.sphere.resize(map.points.cols());
  for (Eigen::Index v = 0; v < map.points.cols(); ++v) {
    auto& point = result.sphere[v];
    point.x = map.points(0, v);
    point.y = map.points(1, v);
    point.z = map.points(2, v);
  }
  result.spread = map.distortion.spread;
  result.worst = map.distortion.worst;
  result.folded = static_cast<std::uint32_t>(map.distortion.folded);
  result.mean_angle = map.distortion.mean_angle;
  result.worst_angle = map.distortion.worst_angle;
}

}  // namespace

mesh::MeshMap MapHandler::mapped(const MeshGoal& goal, MapFollower& follower) {
  mesh::MapOptions options = goal.options;
  options.threads = threads_;
  options.go_on = [&](const mesh::MapProgress& progress) {
    if (!follower.goesOn(progress)) turn_.cancel();
    if (!turn_.cancelled()) return true;
    follower.cancelled();
    if (std::isinf(progress.spread)) {
      throw std::runtime_error("cancelled before there was a map; nothing has changed");
    }
    return false;
  };
  try {
    return mesh::meshMap(goal.mesh, goal.shares, goal.start, options);
  } catch (const std::invalid_argument& fault) {
    throw std::invalid_argument(std::string("mesh: ") + fault.what());
  }
}

void MapHandler::load(core::Scene scene) {
  try {
    runner_.change([&](core::Simulation& s) { s.load({std::move(scene), 0}); });
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& fault) {
    throw std::runtime_error(std::string("mapped, but not loaded: ") + reasonOf(fault));
  }
}

void MapHandler::map(const MapMeshGoal& message, MapMeshResult& result, MapFollower& follower) {
  const auto begin = Clock::now();
  const MeshGoal goal = meshGoalFrom(message);
  if (message.load) requireRoom(limits_, goal.mesh);
  const MapTurn::Busy busy(turn_);
  const mesh::MeshMap map = mapped(goal, follower);
  write(map, result);
  result.message = wordsFor(map, goal.options);
  const auto tellTime = [&] {
    result.wall_time = std::chrono::duration<double>(Clock::now() - begin).count();
  };
  tellTime();
  if (message.load) {
    result.message += kLoaded;
    load(mesh::sceneOfMap(goal.mesh.faces, goal.shares, map.points, goal.options.angle_weight,
                          limits_));
    news_.relaxed("");
    news_.sceneChanged();
  }
  tellTime();
  news_.tell(result.message, "map_mesh: ");
}

}  // namespace spherical_springs
