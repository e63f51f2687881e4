// Undamped scenes whose springs pass places without derivative all the time.
#pragma once

#include <cmath>
#include <type_traits>

#include "scenes.h"

namespace spherical_springs::core::testing {

/// What a random scene has, all at rest at first.
struct Tumbling {
  std::uint32_t particles = 12;
  int arcs = 24, triangles = 12, oriented = 0;
  std::uint32_t pinned = 0;
  bool of_all_masses = false;  ///< over four decades, in place of 1
};

/// Springs join random particles, and are far from rest.
inline Scene tumblingScene(unsigned seed, const Tumbling& has = {}) {
  Random random(seed);
  std::vector<Particle> particles(has.particles);
  for (std::uint32_t i = 0; i < has.particles; ++i) {
    particles[i].position = random.unitVector();
    particles[i].pinned = i < has.pinned;
    if (has.of_all_masses) particles[i].mass = std::pow(10, random.between(-2, 2));
  }
  const auto join = [&](auto& spring) {
    constexpr std::size_t kEnds = std::decay_t<decltype(spring)>::kParticles;
    spring.particles = random.distinctBelow<kEnds>(has.particles);
  };
  SpringLists springs;
  for (int s = 0; s < has.arcs; ++s) {
    AngleSpring spring;
    join(spring);
    spring.rest_angle = random.between(0.2, 2.5);
    spring.stiffness = random.between(0.2, 2);
    springs.get<AngleSpring>().push_back(spring);
  }
  for (int s = 0; s < has.triangles; ++s) {
    SolidAngleSpring spring;
    join(spring);
    spring.rest_solid_angle = random.between(-2, 4);
    spring.stiffness = random.between(0.1, 0.5);
    springs.get<SolidAngleSpring>().push_back(spring);
  }
  for (int s = 0; s < has.oriented; ++s) {
    OrientedAngleSpring spring;
    join(spring);
    spring.rest_angle = random.between(-2, 2);
    spring.width = random.between(0.05, 0.5);
    spring.stiffness = random.between(0.1, 0.5);
    springs.get<OrientedAngleSpring>().push_back(spring);
  }
  return sceneOf(particles, springs);
}

}  // namespace spherical_springs::core::testing
