// Parts of scenes to relax.
#pragma once

#include <cstdint>
#include <vector>

#include "meshes.h"
#include "random.h"
#include "spherical_springs/scene.h"

namespace benchmark_scenes {

using spherical_springs::core::OrientedAngleSpring;
using spherical_springs::core::Points;
using spherical_springs::core::Scene;

/// Where the particles of a scene start: one column each.
Points startOf(const Scene& scene);

/// A scene before it is checked.
struct Parts {
  std::vector<Particle> particles;
  SpringLists springs;

  std::vector<AngleSpring>& arcs() { return springs.get<AngleSpring>(); }
  std::vector<SolidAngleSpring>& triangles() { return springs.get<SolidAngleSpring>(); }
  std::vector<OrientedAngleSpring>& orientedArcs() { return springs.get<OrientedAngleSpring>(); }

  std::uint32_t size() const { return static_cast<std::uint32_t>(particles.size()); }
  void addParticle(const Vector3& position);
  void addArc(std::uint32_t a, std::uint32_t b, double rest, double stiffness = 1);
  Scene scene() const;
};

Parts particlesAt(const std::vector<Vector3>& places);
Parts particlesAnywhere(std::uint32_t count, Random& random);

/// The arc of an edge [rad].
double length(const Mesh& mesh, const std::array<std::uint32_t, 2>& edge);

/// Moves every particle in its tangent plane by a Gaussian of that deviation [rad].
void displace(double deviation, Random& random, Parts& parts);

enum class Springs { arcs, triangles, both };

/// A mesh with angle springs on its edges (stiffness 1, at rest within 10 % of the arc),
/// solid-angle springs on its faces (at rest within 20 % of the area), or both, displaced by a
/// Gaussian of 0.15 mean edges.
Parts displaced(const Mesh& mesh, Springs springs, Random& random, double triangle_stiffness = 10);

/// Springs on the edges and faces of a displaced icosphere.
Parts displacedMesh(int level, Springs springs, Random& random, double triangle_stiffness = 10);

}  // namespace benchmark_scenes
