#include "spherical_springs/maps/map_scene.h"

#include <numeric>
#include <utility>
#include <vector>

namespace spherical_springs::mesh {
namespace {

/// The stiffness at which a spring holds 1/2 J where its angle, or solid angle, is off by all of
/// `rest`.
double stiffnessAt(double rest) { return 1 / (rest * rest); }

std::vector<core::Particle> particlesAt(const Points& map) {
  std::vector<core::Particle> particles(map.cols());
  for (Eigen::Index v = 0; v < map.cols(); ++v) particles[v].position = map.col(v);
  return particles;
}

/// Each edge of a closed mesh rises in one of its two faces.
core::SpringLists springsOf(const Faces& faces, const ValuesRef& shares, const Points& map,
                            double arc_weight) {
  core::SpringLists springs;
  auto& triangles = springs.get<core::SolidAngleSpring>();
  auto& arcs = springs.get<core::AngleSpring>();
  triangles.reserve(faces.cols());
  arcs.reserve(3 * faces.cols() / 2);
  for (Eigen::Index f = 0; f < faces.cols(); ++f) {
    core::SolidAngleSpring triangle;
    for (int k = 0; k < 3; ++k) triangle.particles[k] = static_cast<std::uint32_t>(faces(k, f));
    triangle.rest_solid_angle = shares[f];
    triangle.stiffness = stiffnessAt(triangle.rest_solid_angle);
    triangles.push_back(triangle);
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t from = triangle.particles[k], to = triangle.particles[(k + 1) % 3];
      if (from > to) continue;
      core::AngleSpring arc;
      arc.particles = {from, to};
      arc.rest_angle = core::arc(map.col(from), map.col(to)).angle;
      arc.stiffness = arc_weight * stiffnessAt(arc.rest_angle);
      arcs.push_back(arc);
    }
  }
  return springs;
}

void numberUpTo(std::size_t count, std::vector<std::uint32_t>& ids) {
  ids.resize(count);
  std::iota(ids.begin(), ids.end(), 0);
}

}  // namespace

core::Scene sceneOfMap(const Faces& faces, const ValuesRef& shares, const Points& map,
                       double angle_weight, const core::SceneLimits& limits) {
  constexpr double kWeakest = 1e-5;  // solid-angle springs alone leave some freedom
  core::SpringLists springs = springsOf(faces, shares, map, kWeakest + angle_weight);
  core::SpringIds ids;
  core::forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    numberUpTo(springs.get<Spring>().size(), ids.get<Spring>());
  });
  std::vector<std::uint32_t> particles;
  numberUpTo(map.cols(), particles);
  return {limits, particles, particlesAt(map), ids, std::move(springs)};
}

}  // namespace spherical_springs::mesh
