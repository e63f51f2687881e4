#include <gtest/gtest.h>

#include "spherical_springs/simulation.h"
#include "support/relaxation_scenes.h"
#include "support/scenes.h"

namespace spherical_springs::core {
namespace {

TEST(Simulation, ChangesOfNothingChangeNothing) {
  Simulation simulation({});
  const Scene random = testing::randomScene(7, 10, 10, 0.5, 1);
  simulation.load({random, 0});
  simulation.step(10);
  const double dissipated = simulation.state().dissipated;
  const auto account = simulation.account();
  simulation.addParticles({});
  simulation.setParticles({}, {});
  simulation.removeParticles({});
  simulation.addSprings({});
  simulation.setSprings({}, {});
  simulation.removeSprings({});
  EXPECT_GT(dissipated, 0);
  EXPECT_EQ(simulation.state().dissipated, dissipated);
  EXPECT_EQ(simulation.account(), account);
}

TEST(Simulation, ResetGoesBackToWhereParticlesWereAddedOrSet) {
  Simulation simulation({});
  const Scene random = testing::randomScene(4, 5, 0, 0, 1);
  simulation.addParticles(random.particles().items());
  for (int i = 0; i < 100; ++i) simulation.step();
  simulation.setParticles({1}, {testing::particleAt({0, 0, 1})});
  for (int i = 0; i < 100; ++i) simulation.step();
  simulation.removeParticles({0});
  simulation.reset();
  EXPECT_EQ(simulation.state().time, 0);
  EXPECT_EQ(simulation.state().positions.col(0), Vector3(0, 0, 1));
  EXPECT_EQ(simulation.state().positions.col(1), random.particles().item(2).position);
  EXPECT_EQ(simulation.state().angular_velocities.col(1),
            random.particles().item(2).angular_velocity);
}

TEST(Simulation, KeepsGoingFromWhereItIsWhenTheSceneChanges) {
  Simulation simulation({});
  const Scene random = testing::randomScene(5, 5, 0, 0, 1);
  simulation.addParticles(random.particles().items());
  for (int i = 0; i < 100; ++i) simulation.step();
  const Points before = simulation.state().positions;
  simulation.addParticles({testing::particleAt({0, 0, 1})});
  EXPECT_EQ(simulation.state().positions.leftCols(5), before);
  AngleSpring spring = testing::angleSpring(0, 1, 0);
  spring.at_rest = true;
  SpringLists springs;
  springs.get<AngleSpring>() = {spring};
  simulation.addSprings(springs);
  EXPECT_EQ(simulation.scene().springs<AngleSpring>().item(0).rest_angle,
            arc(before.col(0), before.col(1)).angle);
}

TEST(Simulation, KeepsItsPlanWhenParticlesAreMoved) {
  const Scene scene = testing::pinnedScene(testing::membraneScene(2), {3});
  Simulation simulation({});
  simulation.load({scene, 0});
  simulation.step(10);
  const auto plan = simulation.plan();
  const Points before = simulation.state().positions;
  Particle moved = scene.particles().item(3);
  moved.position = Vector3(1, 2, 2) / 3;
  simulation.setParticles({3}, {moved});
  EXPECT_EQ(simulation.plan(), plan);
  EXPECT_EQ(simulation.state().positions.col(3), moved.position);
  EXPECT_EQ(simulation.state().positions.leftCols(3), before.leftCols(3));
  simulation.reset();
  EXPECT_EQ(simulation.plan(), plan);
}

TEST(Simulation, MakesAnotherPlanWhenMassDampingOrPinChanges) {
  Simulation simulation({});
  simulation.load({testing::membraneScene(1), 0});
  const Particle particle = simulation.scene().particles().item(0);
  Particle heavier = particle, damped = particle, pinned = particle;
  heavier.mass = 2;
  damped.damping = 0.5;
  pinned.pinned = true;
  for (const Particle& other : {heavier, damped, pinned}) {
    simulation.setParticles({0}, {particle});
    const auto plan = simulation.plan();
    simulation.setParticles({1, 0}, {simulation.scene().particles().item(1), other});
    EXPECT_NE(simulation.plan(), plan);
  }
}

TEST(Simulation, StepsOnFromWhereParticlesWereMovedTo) {
  const Scene scene = testing::membraneScene(2);
  Simulation simulation({});
  simulation.load({scene, 0});
  simulation.step(10);
  Particle moved = testing::particleAt({1, 2, 3});
  moved.angular_velocity = moved.position.cross(Vector3(1, 0, 0));
  simulation.setParticles({3}, {moved});
  Simulation anew({});
  anew.load({simulation.presentScene(), 0});
  simulation.step(10);
  anew.step(10);
  EXPECT_LT((simulation.state().positions - anew.state().positions).norm(), 1e-13);
}

}  // namespace
}  // namespace spherical_springs::core
