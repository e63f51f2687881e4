// Undamped scenes whose springs pass places without derivative all the time.
#pragma once

#include <cmath>

#include "scenes.h"

namespace spherical_springs::core::testing {

/// The contents of a random scene, all at rest at first.
struct Tumbling {
  std::uint32_t particles = 12;
  int arcs = 24, triangles = 12, oriented = 0;
  std::uint32_t pinned = 0;
  bool of_all_masses = false;  ///< over four decades, in place of 1
};

/// Adds springs between random particles, each as `make(spring)` sets its numbers.
template <class Spring, class Make>
void addSprings(int count, std::uint32_t particles, Random& random, SpringLists& springs,
                const Make& make) {
  for (int s = 0; s < count; ++s) {
    Spring spring;
    spring.particles = random.distinctBelow<Spring::kParticles>(particles);
    make(spring);
    springs.get<Spring>().push_back(spring);
  }
}

/// A scene whose springs join random particles and are far from rest.
inline Scene tumblingScene(unsigned seed, const Tumbling& has = {}) {
  Random random(seed);
  std::vector<Particle> particles(has.particles);
  for (std::uint32_t i = 0; i < has.particles; ++i) {
    particles[i].position = random.unitVector();
    particles[i].pinned = i < has.pinned;
    if (has.of_all_masses) particles[i].mass = std::pow(10, random.between(-2, 2));
  }
  SpringLists springs;
  addSprings<AngleSpring>(has.arcs, has.particles, random, springs, [&](AngleSpring& spring) {
    spring.rest_angle = random.between(0.2, 2.5);
    spring.stiffness = random.between(0.2, 2);
  });
  addSprings<SolidAngleSpring>(has.triangles, has.particles, random, springs,
                               [&](SolidAngleSpring& spring) {
                                 spring.rest_solid_angle = random.between(-2, 4);
                                 spring.stiffness = random.between(0.1, 0.5);
                               });
  addSprings<OrientedAngleSpring>(has.oriented, has.particles, random, springs,
                                  [&](OrientedAngleSpring& spring) {
                                    spring.rest_angle = random.between(-2, 2);
                                    spring.width = random.between(0.05, 0.5);
                                    spring.stiffness = random.between(0.1, 0.5);
                                  });
  return sceneOf(particles, springs);
}

}  // namespace spherical_springs::core::testing
