#include "node/mesh_goal.h"

#include <limits>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "spherical_springs/maps/mesh_map.h"
#include "spherical_springs/range.h"

namespace spherical_springs {
namespace {

constexpr double kMost = std::numeric_limits<double>::max();

std::string itemOf(const char* list, std::size_t index) {
  return list + ("[" + std::to_string(index) + "]");
}

/// `list`: the name of the points in the goal.
core::Points pointsFrom(const std::vector<geometry_msgs::Point>& messages, const char* list) {
  constexpr core::Range kFinite{-kMost, kMost, "any finite number"};
  core::Points points(3, static_cast<Eigen::Index>(messages.size()));
  for (std::size_t i = 0; i < messages.size(); ++i) {
    const auto& [x, y, z] = std::tie(messages[i].x, messages[i].y, messages[i].z);
    const std::pair<const char*, double> values[] = {{".x", x}, {".y", y}, {".z", z}};
    for (int k = 0; k < 3; ++k) {
      const auto& [name, value] = values[k];
      // The name takes memory, and so waits until it is needed.
      if (!kFinite.contains(value)) {
        core::requireInside(kFinite, value, (itemOf(list, i) + name).c_str());
      }
      points(k, static_cast<Eigen::Index>(i)) = value;
    }
  }
  return points;
}

mesh::Faces facesFrom(const std::vector<shape_msgs::MeshTriangle>& messages, std::size_t vertices) {
  mesh::Faces faces(3, static_cast<Eigen::Index>(messages.size()));
  for (std::size_t f = 0; f < messages.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t vertex = messages[f].vertex_indices[k];
      if (vertex >= vertices) {
        throw std::invalid_argument(itemOf("mesh.triangles", f) + ".vertex_indices[" +
                                    std::to_string(k) + "] is " + std::to_string(vertex) +
                                    (vertices == 0
                                         ? "; the mesh has no vertices"
                                         : "; allowed: 0 to " + std::to_string(vertices - 1)));
      }
      faces(k, static_cast<Eigen::Index>(f)) = static_cast<std::int32_t>(vertex);
    }
  }
  return faces;
}

void requireOneEach(const char* list, std::size_t count, const char* item, std::size_t wanted) {
  if (count == wanted) return;
  throw std::invalid_argument(list + (" has " + std::to_string(count)) +
                              " items; allowed: none, or one a " + item + ", which are " +
                              std::to_string(wanted));
}

core::Values sharesFrom(const std::vector<double>& density, const mesh::TriangleMesh& mesh) {
  constexpr core::Range kPositive{0, kMost, "above 0", true};
  core::Values areas = mesh::faceAreas(mesh);
  if (!density.empty()) {
    requireOneEach("density", density.size(), "triangle", static_cast<std::size_t>(areas.size()));
  }
  for (std::size_t f = 0; f < density.size(); ++f) {
    if (!kPositive.contains(density[f])) {
      core::requireInside(kPositive, density[f], itemOf("density", f).c_str());
    }
    areas[static_cast<Eigen::Index>(f)] *= density[f];
  }
  return mesh::faceShares(areas);
}

mesh::MapOptions optionsFrom(const MapMeshGoal& message) {
  core::requireInside({0, kMost, "0 (meaning 1e-3) or more"}, message.spread, "spread");
  core::requireInside({0, kMost, "0 (by the number of vertices) or more [s]"}, message.max_time,
                      "max_time");
  core::requireInside(mesh::kAngleWeights, message.angle_weight, "angle_weight");
  mesh::MapOptions options;
  options.angle_weight = message.angle_weight;
  if (message.spread > 0) options.tolerance = message.spread;
  options.max_time = message.max_time > 0
                         ? message.max_time
                         : mesh::usualTime(static_cast<Eigen::Index>(message.mesh.vertices.size()));
  return options;
}

}  // namespace

MeshGoal meshGoalFrom(const MapMeshGoal& message) {
  MeshGoal goal;
  goal.options = optionsFrom(message);
  goal.mesh.vertices = pointsFrom(message.mesh.vertices, "mesh.vertices");
  goal.mesh.faces = facesFrom(message.mesh.triangles, message.mesh.vertices.size());
  if (!message.start.empty()) {
    requireOneEach("start", message.start.size(), "vertex", message.mesh.vertices.size());
    goal.start = pointsFrom(message.start, "start");
  }
  if (!message.mesh.triangles.empty() || !message.density.empty()) {
    goal.shares = sharesFrom(message.density, goal.mesh);
  }
  return goal;
}

}  // namespace spherical_springs
