// Springs that join particles without coupling them: a relaxation ends, and takes little memory.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "spherical_springs/relaxation.h"
#include "support/relaxation_scenes.h"
#include "support/trajectory.h"

namespace spherical_springs::core {
namespace {

using testing::angleSpring;
using testing::positionsOf;

/// Oriented springs on one arc whose signs are settled, so that their third particles feel nothing.
Scene fanScene(std::uint32_t count) {
  std::vector<Particle> particles = {testing::particleAt({1, 0, 0}),
                                     testing::particleAt({0, 1, 0})};
  SpringLists springs;
  for (std::uint32_t i = 0; i < count; ++i) {
    particles.push_back(testing::particleAt({0.1 * std::cos(i), 0.1 * std::sin(i), 1}));
    OrientedAngleSpring spring;
    spring.particles = {0, 1, 2 + i};
    spring.rest_angle = spring.stiffness = 1;
    springs.get<OrientedAngleSpring>().push_back(spring);
  }
  return testing::sceneOf(particles, springs);
}

TEST(MissingCouplings, OfSettledSignsLetRelaxationsEnd) {
  for (const std::uint32_t count : {24u, 40u, 1000u}) {
    const Scene scene = fanScene(count);
    const auto result = relax(System(scene, {}), positionsOf(scene), {});
    EXPECT_TRUE(result.converged) << result.message;
    EXPECT_LT(result.energy_after, 1e-15 * count);
  }
}

TEST(MissingCouplings, OfSettledSignsLetImplicitStepsEnd) {
  const testing::Trajectory trajectory(fanScene(40), "implicit_euler", 0.1, 3);
  testing::expectSound(trajectory.state);
  EXPECT_EQ(trajectory.state.unconverged_steps, 0u);
}

// Beside a stiffness of 1e23 the squares of those in the chain are 0 in single precision.
TEST(MissingCouplings, OfSoftSpringsBesideStiffOnesLetRelaxationsEnd) {
  testing::Random random(1);
  std::vector<Particle> particles;
  SpringLists springs;
  for (std::uint32_t i = 0; i < 60; ++i) {
    particles.push_back(testing::particleAt(random.unitVector()));
    if (i > 0 && i != 58) springs.get<AngleSpring>().push_back(angleSpring(i - 1, i, 1));
  }
  springs.get<AngleSpring>().back().stiffness = 1e23;
  const Scene scene = testing::sceneOf(particles, springs);
  const auto result = relax(System(scene, {}), positionsOf(scene), {});
  EXPECT_TRUE(result.converged) << result.message;
  for (const AngleSpring& spring : springs.get<AngleSpring>()) {
    const auto& [a, b] = spring.particles;
    EXPECT_NEAR(arc(result.positions.col(a), result.positions.col(b)).angle, 1, 1e-8);
  }
}

}  // namespace
}  // namespace spherical_springs::core
