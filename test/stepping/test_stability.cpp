// Stability of the explicit steps, and what is left after a million of them.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "meshes.h"
#include "stepping/stability.h"
#include "support/scenes.h"
#include "support/trajectory.h"

namespace spherical_springs::core {
namespace {

using testing::angleSpring;
using testing::arcs;
using testing::expectSound;
using testing::threeArcs;
using testing::Trajectory;

// Stable at 0.95 of the bound over many steps; the pair is where the bound is sharpest.
TEST(StableTimeStep, Holds) {
  for (const char* method : {"euler", "verlet", "fourth_order"}) {
    for (unsigned seed = 1; seed <= 5; ++seed) {
      std::vector<Particle> particles(2);
      testing::Random random(seed);
      const double rest = random.between(0.5, 2.5);
      particles[0].position = Vector3(1, 0, 0);
      particles[1].position = Vector3(std::cos(rest + 1e-3), std::sin(rest + 1e-3), 0);
      particles[0].mass = particles[1].mass = random.between(0.1, 10);
      const Scene scene = testing::sceneOf(particles, arcs({angleSpring(0, 1, rest)}));
      const Trajectory start(scene, method, 1, 0);
      const double stable =
          stableTimeStep(start.system(), integrationMethod(method), start.state.positions);
      const Trajectory end(scene, method, 0.95 * stable, 10000);
      EXPECT_LT(end.conserved(), 20 * start.conserved()) << method;
      const Trajectory beyond(scene, method, 2.2 * stable, 1000);
      EXPECT_GT(beyond.conserved(), 20 * start.conserved()) << "the bound is loose by half";
    }
  }
}

/// A triangle of the largest stiffness on the lightest particles with an edge of pi - `away`.
Scene nearlyAntipodal(double away, double damping = 0) {
  SpringLists springs;
  springs.get<SolidAngleSpring>() = {testing::solidAngleSpring(0, 1, 2, -1)};
  springs.get<SolidAngleSpring>()[0].stiffness = 1e30;
  springs.get<SolidAngleSpring>()[0].damping = damping;
  std::vector<Particle> particles = {testing::particleAt({0.6, 0, 0.8}),
                                     testing::particleAt({-1, away, 0}),
                                     testing::particleAt({1, 0, 0})};
  for (Particle& particle : particles) particle.mass = 1e-30;
  return testing::sceneOf(particles, springs);
}

TEST(NearlyAntipodal, HasAStableTimeStepAboveZero) {
  for (const double away : {1e-143, 1e-31, 1e-29, 1e-16}) {
    const Scene scene = nearlyAntipodal(away);
    const System system(scene, System::Options());
    const Points positions = testing::stateOf(scene).positions;
    EXPECT_TRUE(std::isfinite(highestFrequency(system, positions))) << away;
    EXPECT_GT(stableTimeStep(system, IntegrationMethod::verlet, positions), 0) << away;
    const double step = stableTimeStep(system, IntegrationMethod::implicit_euler, positions);
    EXPECT_TRUE(std::isinf(step)) << step;
  }
}

TEST(NearlyAntipodal, StepsToFiniteStates) {
  for (const char* method : {"euler", "verlet", "fourth_order", "implicit_euler"}) {
    for (const double away : {1e-143, 1e-31, 1e-29, 1e-16}) {
      for (const double damping : {0., 5e-324, 1e-30, 1e-3, 1e30}) {
        for (const double time_step : {1e-12, 0.1, 1e6}) {
          const Trajectory end(nearlyAntipodal(away, damping), method, time_step, 4);
          ASSERT_TRUE(end.state.positions.allFinite())
              << method << " " << away << " " << damping << " " << time_step;
          ASSERT_TRUE(end.state.angular_velocities.allFinite())
              << method << " " << away << " " << damping << " " << time_step;
        }
      }
    }
  }
}

/// An icosphere with springs of arcs and triangles, a little out of shape.
Scene mesh() {
  const auto sphere = benchmark_scenes::icosphere(1);
  testing::Random random(1);
  std::vector<Particle> particles;
  for (const Vector3& vertex : sphere.vertices) {
    particles.push_back(testing::particleAt(vertex + 1e-3 * random.unitVector()));
  }
  SpringLists springs;
  for (const auto& [a, b] : sphere.edges) {
    springs.get<AngleSpring>().push_back(angleSpring(a, b, 0));
    springs.get<AngleSpring>().back().at_rest = true;
  }
  for (const auto& [a, b, c] : sphere.faces) {
    springs.get<SolidAngleSpring>().push_back(testing::solidAngleSpring(a, b, c, 4 * kPi / 80));
    springs.get<SolidAngleSpring>().back().stiffness = 10;
  }
  return testing::sceneOf(particles, springs);
}

TEST(StableTimeStep, OfAMeshHoldsAndIsWithinAFactorOf2) {
  const Trajectory start(mesh(), "verlet", 1, 0);
  const double stable =
      stableTimeStep(start.system(), IntegrationMethod::verlet, start.state.positions);
  const double energy = start.conserved();
  EXPECT_LT(Trajectory(mesh(), "verlet", 0.95 * stable, 5000).conserved(), 2 * energy);
  EXPECT_GT(Trajectory(mesh(), "verlet", 2 * stable, 500).conserved(), 100 * energy);
}

// A million steps: no drift of energy, momentum kept to rounding.
TEST(LongRun, KeepsEnergyAndAngularMomentum) {
  const Scene scene =
      testing::sceneOf({testing::particleAt({1, 0.15, 0.05}), testing::particleAt({0.1, 1, 0.1}),
                        testing::particleAt({0.1, 0.2, 1})},
                       threeArcs());
  for (const char* method : {"euler", "verlet", "fourth_order"}) {
    const Trajectory start(scene, method, 1e-2, 0);
    Account account(*start.plan, start.state);
    const Trajectory early(scene, method, 1e-2, 10000);
    const Trajectory end(scene, method, 1e-2, 1000000);
    const Vector3 momentum = end.system().angularMomentum(end.state.angular_velocities);
    EXPECT_LT(momentum.norm(), 1e-12) << method;
    const double bound = std::pow(10, -2 * orderOf(integrationMethod(method)));
    EXPECT_LT(account.energyError(energies(*early.plan, early.state)), bound);
    EXPECT_LT(account.energyError(energies(*end.plan, end.state)), bound);
    expectSound(end.state);
  }
}

// A light particle keeps only rounding of its velocity under fast dampers, in any direction.
TEST(StrongDamping, OfALightParticleLeavesItOnTheSphere) {
  for (const char* method : {"euler", "verlet", "fourth_order", "implicit_euler"}) {
    for (unsigned seed = 1; seed <= 100; ++seed) {
      testing::Random random(seed);
      std::vector<Particle> particles(2);
      for (Particle& particle : particles) particle.position = random.unitVector();
      particles[0].mass = kSmallest;
      particles[1].pinned = true;
      AngleSpring spring = angleSpring(0, 1, 3);
      spring.damping = random.between(0.1, 10);
      const Scene scene = testing::sceneOf(particles, arcs({spring}));
      SCOPED_TRACE(method + (" from seed " + std::to_string(seed)));
      expectSound(Trajectory(scene, method, 1, 4).state);
    }
  }
}

// Damping that is slow where a step begins and fast within it, where kicks go back in time.
TEST(StrongDamping, NearAntipodalVerticesStaysFinite) {
  std::vector<Particle> particles(3);
  particles[0].position = Vector3(1, 0, 0);
  particles[0].angular_velocity = Vector3(0, 1, 2);
  particles[1].position = Vector3(-1, 0, 0);
  particles[2].position = Vector3(0, 1, 0);
  particles[1].pinned = particles[2].pinned = true;
  SpringLists springs;
  springs.get<SolidAngleSpring>() = {testing::solidAngleSpring(0, 1, 2, 0)};
  springs.get<SolidAngleSpring>()[0].damping = 4;
  const Scene scene = testing::sceneOf(particles, springs);
  for (const char* method : {"euler", "verlet", "fourth_order", "implicit_euler"}) {
    SCOPED_TRACE(method);
    const Trajectory end(scene, method, 1e-3, 10);
    expectSound(end.state);
    EXPECT_LT(end.state.angular_velocities.norm(), 1.1 * particles[0].angular_velocity.norm());
  }
}

TEST(LongRun, OfAThousandParticlesStaysSound) {
  const std::uint32_t count = 1000;
  testing::Random random(1);
  std::vector<Particle> particles;
  SpringLists springs;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double turn = 2 * kPi * i / count;
    particles.push_back(testing::particleAt(Vector3(std::cos(turn), std::sin(turn), 0) +
                                            2e-3 * random.unitVector()));
    springs.get<AngleSpring>().push_back(angleSpring(i, (i + 1) % count, 2 * kPi / count));
  }
  const Scene scene = testing::sceneOf(particles, springs);
  const Trajectory start(scene, "verlet", 0.1, 0);
  const Trajectory end(scene, "verlet", 0.1, 1000000);
  EXPECT_NEAR(end.conserved(), start.conserved(), 0.02 * start.conserved());
  EXPECT_LT(end.system().angularMomentum(end.state.angular_velocities).norm(), 1e-12);
  expectSound(end.state);
}

}  // namespace
}  // namespace spherical_springs::core
