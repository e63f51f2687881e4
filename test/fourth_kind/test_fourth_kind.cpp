// A kind of spring of which only the formula exists, beside the others. The tests of stepping and
// of energies that are compiled into the same program have springs of it in their random scenes.
#include <gtest/gtest.h>

#include <sstream>

#include "relaxation/tangent_energy.h"
#include "spherical_springs/relaxation.h"
#include "spherical_springs/scene_file.h"
#include "stepping/plain_springs.h"
#include "support/relaxation_scenes.h"
#include "support/trajectory.h"

namespace spherical_springs::core {
namespace {

using testing::positionsOf;
using testing::randomScene;

/// Springs of the fourth kind alone, on particles of several patches.
Scene fourthKindAlone(std::uint32_t particles, int count, double damping = 0) {
  testing::Random random(5);
  std::vector<Particle> list(particles);
  for (Particle& particle : list) particle.position = random.unitVector();
  SpringLists springs;
  for (int i = 0; i < count; ++i) {
    auto spring = random.spring<TwoCosinesSpring>(random.distinctBelow<4>(particles));
    spring.rest_sum = random.between(-2, 2);
    spring.damping = damping;
    springs.get<TwoCosinesSpring>().push_back(spring);
  }
  return testing::sceneOf(list, springs);
}

TEST(FourthKind, IsOneOfTheList) {
  int kinds = 0;
  forEachKind([&](auto) { ++kinds; });
  EXPECT_EQ(kinds, 4);
  EXPECT_EQ(kMostEnds, 4u);
  EXPECT_FALSE(kHasStepKernels<TwoCosinesSpring>);
}

TEST(FourthKind, HasItsEnergyInEveryMeasure) {
  const Scene scene = fourthKindAlone(3000, 4000);
  const Plan plan(scene, {});
  const Points positions = positionsOf(scene);
  double expected = 0;
  for (const TwoCosinesSpring& spring : plan.system()->springs<TwoCosinesSpring>()) {
    const double c = condition(spring, System::points(spring, positions)).value;
    expected += 0.5 * spring.stiffness * c * c;
  }
  const State state = testing::stateOf(scene);
  EXPECT_GT(expected, 100);
  EXPECT_NEAR(energies(plan, state).by_kind.get<TwoCosinesSpring>().joules, expected,
              1e-13 * expected);
  const double of_relaxation =
      testing::energyAt(*plan.system(), positions, Curvature::definite).energy();
  EXPECT_NEAR(of_relaxation, expected, 1e-13 * expected);
}

TEST(FourthKind, TurnsPotentialIntoKineticEnergyAndBack) {
  const Scene scene = fourthKindAlone(1500, 3000);
  const testing::Trajectory verlet(scene, "verlet", 0.01, 200);
  const testing::Trajectory fourth_order(scene, "fourth_order", 0.01, 200);
  const double start = energies(*verlet.plan, testing::stateOf(scene)).total();
  EXPECT_GT(verlet.system().kinetic(verlet.state.angular_velocities), 0.1 * start);
  EXPECT_NEAR(verlet.conserved(), start, 1e-3 * start);
  EXPECT_NEAR(fourth_order.conserved(), start, 1e-6 * start);
}

TEST(FourthKind, IsDampedToRestWithoutLossOfTheAccount) {
  const testing::Trajectory damped(fourthKindAlone(1500, 3000, 0.3), "verlet", 0.01, 200);
  const double start =
      energies(*damped.plan, testing::stateOf(fourthKindAlone(1500, 3000, 0.3))).total();
  EXPECT_GT(damped.state.dissipated, 0.2 * start);
  EXPECT_NEAR(damped.conserved(), start, 1e-2 * start);
}

TEST(FourthKind, IsRelaxedByEveryMethod) {
  const Scene scene = fourthKindAlone(300, 200);
  const System system(scene, {});
  for (const char* method : {"newton", "dynamics", "fire"}) {
    RelaxationOptions options;
    options.method = relaxationMethod(method);
    const RelaxationResult result = relax(system, positionsOf(scene), options);
    EXPECT_TRUE(result.converged) << method << ": " << result.message;
    EXPECT_LT(result.energy_after, 0.1 * result.energy_before) << method;
  }
}

TEST(FourthKind, IsReadFromSceneFilesAsItWasWritten) {
  const Scene scene = randomScene(3, 20, 10, 0.5);
  std::stringstream file;
  writeScene(file, scene, 0);
  const SceneFile read = readScene(file, {});
  const auto& written = scene.springs<TwoCosinesSpring>().items();
  const auto& springs = read.scene.springs<TwoCosinesSpring>().items();
  ASSERT_EQ(springs.size(), 10u);
  for (std::size_t s = 0; s < springs.size(); ++s) {
    EXPECT_EQ(springs[s].particles, written[s].particles);
    EXPECT_EQ(springs[s].rest_sum, written[s].rest_sum);
    EXPECT_EQ(springs[s].stiffness, written[s].stiffness);
    EXPECT_EQ(springs[s].damping, written[s].damping);
  }
}

}  // namespace
}  // namespace spherical_springs::core
