// Points and scenes for tests, the same every run.
#pragma once

#include <random>
#include <vector>

#include "spherical_springs/scene.h"
#include "spherical_springs/state.h"

namespace spherical_springs::core::testing {

class Random {
 public:
  explicit Random(unsigned seed) : generator_(seed) {}

  double between(double low, double high) {
    return low + (high - low) * (generator_() / 4294967296.);
  }
  std::uint32_t below(std::uint32_t count) { return generator_() % count; }

  Vector3 unitVector() {
    Vector3 v;
    do {
      v = Vector3(between(-1, 1), between(-1, 1), between(-1, 1));
    } while (v.squaredNorm() > 1 || v.squaredNorm() < 0.01);
    return v.normalized();
  }

  template <std::size_t N>
  std::array<Vector3, N> unitVectors() {
    std::array<Vector3, N> result;
    for (Vector3& v : result) v = unitVector();
    return result;
  }

  template <std::size_t N>
  std::array<std::uint32_t, N> distinctBelow(std::uint32_t count) {
    std::array<std::uint32_t, N> result;
    for (std::size_t i = 0; i < N; ++i) {
      do {
        result[i] = below(count);
      } while (std::find(result.begin(), result.begin() + i, result[i]) != result.begin() + i);
    }
    return result;
  }

  /// A spring on `particles` whose fields are well inside their ranges.
  template <class Spring>
  Spring spring(const std::array<std::uint32_t, Spring::kParticles>& particles) {
    Spring spring;
    spring.particles = particles;
    spring.stiffness = between(0.5, 2);
    setRest(spring);
    return spring;
  }

 private:
  void setRest(AngleSpring& spring) { spring.rest_angle = between(0.3, 2.5); }
  void setRest(SolidAngleSpring& spring) { spring.rest_solid_angle = between(-2, 2); }
  void setRest(OrientedAngleSpring& spring) {
    spring.rest_angle = between(-2, 2);
    spring.width = between(0.3, 1);
  }
  template <class Spring>
  void setRest(Spring&) {}  // of a kind that a test brings

  std::mt19937 generator_;
};

inline Particle particleAt(const Vector3& position) {
  Particle particle;
  particle.position = position;
  return particle;
}

inline AngleSpring angleSpring(std::uint32_t a, std::uint32_t b, double rest_angle) {
  AngleSpring spring;
  spring.particles = {a, b};
  spring.rest_angle = rest_angle;
  spring.stiffness = 1;
  return spring;
}

inline SolidAngleSpring solidAngleSpring(std::uint32_t a, std::uint32_t b, std::uint32_t c,
                                         double rest_solid_angle) {
  SolidAngleSpring spring;
  spring.particles = {a, b, c};
  spring.rest_solid_angle = rest_solid_angle;
  spring.stiffness = 1;
  return spring;
}

inline Points positionsOf(const Scene& scene) {
  Points positions(3, scene.particles().size());
  for (Eigen::Index i = 0; i < positions.cols(); ++i) {
    positions.col(i) = scene.particles().item(i).position;
  }
  return positions;
}

inline State stateOf(const Scene& scene) {
  State state;
  state.positions = positionsOf(scene);
  state.angular_velocities = Points(3, scene.particles().size());
  for (Eigen::Index i = 0; i < state.positions.cols(); ++i) {
    state.angular_velocities.col(i) = scene.particles().item(i).angular_velocity;
  }
  return state;
}

inline SpringLists springsOf(const Scene& scene) {
  SpringLists springs;
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    const auto& items = scene.springs<Spring>().items();
    springs.get<Spring>().assign(items.begin(), items.end());
  });
  return springs;
}

inline Scene sceneOf(const std::vector<Particle>& particles, const SpringLists& springs) {
  Scene scene;
  scene.addParticles(particles);
  scene.addSprings(springs, positionsOf(scene));
  return scene;
}

/// `springs_each` springs of every kind on `particles` particles at random places, at rest or
/// moving with up to `speed` [rad/s].
inline Scene randomScene(unsigned seed, std::uint32_t particles, int springs_each,
                         double damping = 0, double speed = 0) {
  Random random(seed);
  std::vector<Particle> list(particles);
  for (Particle& particle : list) {
    particle.position = random.unitVector();
    particle.mass = random.between(0.5, 2);
    particle.angular_velocity = speed * random.unitVector();
  }
  SpringLists springs;
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    for (int i = 0; i < springs_each; ++i) {
      auto spring = random.spring<Spring>(random.distinctBelow<Spring::kParticles>(particles));
      spring.damping = damping;
      springs.get<Spring>().push_back(spring);
    }
  });
  return sceneOf(list, springs);
}

/// A chain of many particles, each joined with the next two by springs of every kind.
inline Scene chainScene(unsigned seed, std::uint32_t count, double damping) {
  Random random(seed);
  std::vector<Particle> particles(count);
  Vector3 place = random.unitVector();
  for (Particle& particle : particles) {
    place = (place + 0.2 * random.unitVector()).normalized();
    particle.position = place;
  }
  SpringLists springs;
  for (std::uint32_t i = 0; i + 2 < count; ++i) {
    springs.get<AngleSpring>().push_back(random.spring<AngleSpring>({i, i + 1}));
    springs.get<SolidAngleSpring>().push_back(random.spring<SolidAngleSpring>({i, i + 1, i + 2}));
    springs.get<OrientedAngleSpring>().push_back(
        random.spring<OrientedAngleSpring>({i, i + 1, i + 2}));
    springs.get<AngleSpring>().back().damping = damping;
  }
  return sceneOf(particles, springs);
}

inline SpringLists arcs(std::initializer_list<AngleSpring> list) {
  SpringLists springs;
  springs.get<AngleSpring>() = list;
  return springs;
}

/// Figure 3 of the report.
inline SpringLists threeArcs() {
  return arcs({angleSpring(0, 1, kPi / 2), angleSpring(1, 2, kPi / 2), angleSpring(2, 0, kPi / 2)});
}

inline SpringLists threeOrientedArcs() {
  SpringLists springs;
  for (std::uint32_t i = 0; i < 3; ++i) {
    OrientedAngleSpring spring;
    spring.particles = {i, (i + 1) % 3, (i + 2) % 3};
    spring.rest_angle = kPi / 2;
    spring.stiffness = 1;
    springs.get<OrientedAngleSpring>().push_back(spring);
  }
  return springs;
}

}  // namespace spherical_springs::core::testing
