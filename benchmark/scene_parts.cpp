#include "scene_parts.h"

#include <numeric>

namespace benchmark_scenes {
namespace {

using spherical_springs::core::arc;
using spherical_springs::core::rotated;
using spherical_springs::core::solidAngle;
using spherical_springs::core::tangentFrame;

void addArcs(const Mesh& mesh, Random& random, Parts& parts) {
  for (const auto& edge : mesh.edges) {
    parts.addArc(edge[0], edge[1], length(mesh, edge) * random.between(0.9, 1.1));
  }
}

void addTriangles(const Mesh& mesh, Random& random, double stiffness, Parts& parts) {
  for (const auto& face : mesh.faces) {
    const auto& v = mesh.vertices;
    parts.triangles().emplace_back();
    SolidAngleSpring& spring = parts.triangles().back();
    spring.particles = face;
    spring.rest_solid_angle =
        solidAngle(v[face[0]], v[face[1]], v[face[2]]) * random.between(0.8, 1.2);
    spring.stiffness = stiffness;
  }
}

void displaceByEdges(const Mesh& mesh, Random& random, Parts& parts) {
  const double sum =
      std::accumulate(mesh.edges.begin(), mesh.edges.end(), 0.,
                      [&](double part, const auto& edge) { return part + length(mesh, edge); });
  displace(0.15 * sum / mesh.edges.size(), random, parts);
}

}  // namespace

Points startOf(const Scene& scene) {
  const auto& particles = scene.particles().items();
  Points positions(3, particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i) positions.col(i) = particles[i].position;
  return positions;
}

void Parts::addParticle(const Vector3& position) {
  particles.emplace_back();
  particles.back().position = position;
}

void Parts::addArc(std::uint32_t a, std::uint32_t b, double rest, double stiffness) {
  arcs().emplace_back();
  arcs().back().particles = {a, b};
  arcs().back().rest_angle = rest;
  arcs().back().stiffness = stiffness;
}

Scene Parts::scene() const {
  Scene scene;
  scene.addParticles(particles);
  scene.addSprings(springs, startOf(scene));
  return scene;
}

Parts particlesAt(const std::vector<Vector3>& places) {
  Parts parts;
  for (const Vector3& place : places) parts.addParticle(place);
  return parts;
}

Parts particlesAnywhere(std::uint32_t count, Random& random) {
  Parts parts;
  for (std::uint32_t i = 0; i < count; ++i) parts.addParticle(random.direction());
  return parts;
}

double length(const Mesh& mesh, const std::array<std::uint32_t, 2>& edge) {
  return arc(mesh.vertices[edge[0]], mesh.vertices[edge[1]]).angle;
}

void displace(double deviation, Random& random, Parts& parts) {
  for (Particle& particle : parts.particles) {
    Eigen::Vector2d step;
    for (int k = 0; k < 2; ++k) step[k] = deviation * random.normal();
    particle.position = rotated(particle.position, tangentFrame(particle.position) * step);
  }
}

Parts displaced(const Mesh& mesh, Springs springs, Random& random, double triangle_stiffness) {
  Parts parts = particlesAt(mesh.vertices);
  if (springs != Springs::triangles) addArcs(mesh, random, parts);
  if (springs != Springs::arcs) addTriangles(mesh, random, triangle_stiffness, parts);
  displaceByEdges(mesh, random, parts);
  return parts;
}

Parts displacedMesh(int level, Springs springs, Random& random, double triangle_stiffness) {
  return displaced(icosphere(level), springs, random, triangle_stiffness);
}

}  // namespace benchmark_scenes
