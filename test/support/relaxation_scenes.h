// Larger scenes for the tests of relaxation and of what it is built from.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "meshes.h"
#include "relaxation/tangent_energy.h"
#include "scenes.h"

namespace spherical_springs::core::testing {

inline Vector3 displaced(const Vector3& point, double distance, Random& random) {
  return rotated(point, distance * point.cross(random.unitVector()));
}

/// An icosphere whose edges are angle springs, at rest within a tenth of their present arc, and
/// whose faces are ten times as stiff solid-angle springs, at rest within a fifth; every particle
/// displaced by up to a third of an edge.
inline Scene membraneScene(int level, unsigned seed = 1) {
  Random random(seed);
  const auto mesh = benchmark_scenes::icosphere(level);
  SpringLists springs;
  for (const auto& [a, b] : mesh.edges) {
    const double present = arc(mesh.vertices[a], mesh.vertices[b]).angle;
    springs.get<AngleSpring>().push_back(angleSpring(a, b, random.between(0.9, 1.1) * present));
  }
  for (const auto& [a, b, c] : mesh.faces) {
    const double present = solidAngle(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
    springs.get<SolidAngleSpring>().push_back(
        solidAngleSpring(a, b, c, random.between(0.8, 1.2) * present));
    springs.get<SolidAngleSpring>().back().stiffness = 10;
  }
  const double edge = springs.get<AngleSpring>().front().rest_angle;
  std::vector<Particle> particles;
  for (const Vector3& vertex : mesh.vertices) {
    particles.push_back(particleAt(displaced(vertex, random.between(0, 0.3) * edge, random)));
  }
  return sceneOf(particles, springs);
}

/// The particles and springs of `scene`, some of the particles pinned.
inline Scene pinnedScene(const Scene& scene, const std::vector<std::uint32_t>& pins) {
  auto particles = scene.particles().items();
  for (const std::uint32_t i : pins) particles[i].pinned = true;
  return sceneOf(particles, springsOf(scene));
}

template <class Real>
Eigen::MatrixXd dense(const BlockPattern& pattern, const Blocks<Real, 2>& values) {
  const auto size = static_cast<Eigen::Index>(2 * pattern.rows());
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(size, size);
  for (std::uint32_t i = 0; i < pattern.rows(); ++i) {
    for (std::uint32_t e = pattern.graph.first[i]; e < pattern.graph.first[i + 1]; ++e) {
      result.block<2, 2>(2 * i, 2 * pattern.graph.neighbours[e]) =
          values[e].template cast<double>();
    }
  }
  return result;
}

/// The energy of a scene where its particles are.
inline TangentEnergy energyAt(const System& system, const Points& positions, Curvature curvature) {
  TangentEnergy energy(system, positions);
  energy.place(positions);
  energy.evaluate(curvature);
  return energy;
}

}  // namespace spherical_springs::core::testing
