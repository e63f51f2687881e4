#include "work_scenes.h"

#include <cmath>
#include <random>

#include "meshes.h"
#include "support/tumbling_scenes.h"

namespace benchmark_scenes {

using namespace spherical_springs::core;  // NOLINT: a program, not a header

using testing::sceneOf;

namespace {

AngleSpring angleSpring(std::uint32_t a, std::uint32_t b, double rest, double stiffness) {
  AngleSpring spring;
  spring.particles = {a, b};
  spring.rest_angle = rest;
  spring.stiffness = stiffness;
  return spring;
}

WorkScene pair() {
  std::vector<Particle> particles(2);
  SpringLists springs;
  springs.get<AngleSpring>() = {angleSpring(0, 1, 1, 1)};
  const auto at = [](double time) {
    const double half = (1 + 0.3 * std::cos(std::sqrt(2.) * time)) / 2;
    Points positions(3, 2);
    positions.col(0) = Vector3(std::cos(half), -std::sin(half), 0);
    positions.col(1) = Vector3(std::cos(half), std::sin(half), 0);
    return positions;
  };
  for (int i = 0; i < 2; ++i) particles[i].position = at(0).col(i);
  return {"pair", sceneOf(particles, springs), 20, at};
}

std::vector<Particle> spread(double damping) {
  std::vector<Particle> particles(3);
  particles[0].position = Vector3(1, 0.15, 0.05);
  particles[1].position = Vector3(0.9, 0.5, 0.1);
  particles[2].position = Vector3(0.9, 0.1, 0.5);
  for (Particle& particle : particles) particle.damping = damping;
  return particles;
}

SpringLists triangleOfArcs(double damping, double stiffest) {
  SpringLists springs;
  springs.get<AngleSpring>() = {angleSpring(0, 1, kPi / 2, stiffest), angleSpring(1, 2, kPi / 2, 1),
                                angleSpring(2, 0, kPi / 2, 1)};
  for (AngleSpring& spring : springs.get<AngleSpring>()) spring.damping = damping;
  return springs;
}

}  // namespace

Scene mesh(double damping) {
  const Mesh sphere = icosphere(3);
  std::mt19937 generator(1);
  const auto noise = [&] { return generator() / 2147483648. - 1; };
  std::vector<Particle> particles(sphere.vertices.size());
  for (std::size_t i = 0; i < particles.size(); ++i) {
    particles[i].position = sphere.vertices[i] + 0.01 * Vector3(noise(), noise(), noise());
  }
  SpringLists springs;
  for (const auto& [a, b] : sphere.edges) {
    const double angle = arc(sphere.vertices[a], sphere.vertices[b]).angle;
    springs.get<AngleSpring>().push_back(angleSpring(a, b, angle * (1 + 0.1 * noise()), 1));
    springs.get<AngleSpring>().back().damping = damping;
  }
  for (const auto& face : sphere.faces) {
    const auto& v = sphere.vertices;
    SolidAngleSpring spring;
    spring.particles = face;
    spring.rest_solid_angle = solidAngle(v[face[0]], v[face[1]], v[face[2]]) * (1 + 0.2 * noise());
    spring.stiffness = 10;
    springs.get<SolidAngleSpring>().push_back(spring);
  }
  return sceneOf(particles, springs);
}

std::vector<WorkScene> workScenes() {
  return {pair(),
          {"figure 3", sceneOf(spread(0.5), triangleOfArcs(0, 1)), 10, nullptr},
          {"mesh", mesh(0), 5, nullptr},
          {"damped mesh", mesh(0.2), 5, nullptr},
          {"stiff", sceneOf(spread(0), triangleOfArcs(0, 1e6)), 0.2, nullptr},
          // Until its way depends on all that came before.
          {"tumbling", testing::tumblingScene(3), 4, nullptr}};
}

}  // namespace benchmark_scenes
