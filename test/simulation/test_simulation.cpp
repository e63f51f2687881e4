#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "spherical_springs/plan.h"
#include "spherical_springs/simulation.h"
#include "stepping/layout.h"
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

/// Gives every spring of a kind other numbers, under the ids that they have.
template <class Spring>
void setAll(Simulation& simulation, const std::function<void(Spring&)>& change) {
  SpringIds ids;
  SpringLists springs;
  ids.get<Spring>().assign(simulation.scene().springs<Spring>().ids().begin(),
                           simulation.scene().springs<Spring>().ids().end());
  for (Spring spring : simulation.scene().springs<Spring>().items()) {
    change(spring);
    springs.get<Spring>().push_back(spring);
  }
  simulation.setSprings(ids, springs);
}

TEST(Simulation, KeepsTheOrderOfItsPlanWhenNumbersChange) {
  Simulation simulation({});
  simulation.load({testing::randomScene(2, 200, 300), 0});
  const auto order = simulation.plan()->layout().order();
  auto particles = simulation.scene().particles().items();
  std::reverse(particles.begin(), particles.end());
  simulation.setParticles(simulation.scene().particles().ids(), particles);
  ASSERT_NE(Plan(simulation.scene(), {}).layout().order(), order);
  setAll<AngleSpring>(simulation, [](AngleSpring& spring) { spring.rest_angle /= 2; });
  EXPECT_EQ(simulation.plan()->layout().order(), order);
  setAll<AngleSpring>(
      simulation, [](AngleSpring& spring) { std::swap(spring.particles[0], spring.particles[1]); });
  EXPECT_NE(simulation.plan()->layout().order(), order);
}

TEST(Simulation, StepsBySpringsAndParticlesAsTheyWereSet) {
  testing::Random random(4);
  const Scene mesh = testing::membraneScene(4);
  SpringLists springs = testing::springsOf(mesh);
  for (const SolidAngleSpring& triangle : springs.get<SolidAngleSpring>()) {
    auto spring = random.spring<OrientedAngleSpring>(triangle.particles);
    spring.damping = 0.2;
    springs.get<OrientedAngleSpring>().push_back(spring);
  }
  Simulation simulation({});
  simulation.load({testing::sceneOf(mesh.particles().items(), springs), 0});
  const std::vector<std::function<void()>> changes = {
      [&] {
        setAll<AngleSpring>(simulation, [&](auto& s) { s.rest_angle *= random.between(1, 2); });
      },
      [&] { setAll<SolidAngleSpring>(simulation, [](auto& s) { s.stiffness *= 3; }); },
      [&] { setAll<OrientedAngleSpring>(simulation, [](auto& s) { s.width = s.damping = 0.1; }); },
      [&] {
        auto particles = simulation.presentScene().particles().items();
        for (Particle& particle : particles) particle.mass = random.between(0.5, 3);
        particles[7].pinned = true;
        simulation.setParticles(simulation.scene().particles().ids(), particles);
      }};
  for (const auto& change : changes) {
    simulation.step(3);
    change();
    Simulation anew({});
    anew.load({simulation.presentScene(), simulation.state().time});
    simulation.step(10);
    anew.step(10);
    EXPECT_LT((simulation.state().positions - anew.state().positions).norm(), 1e-12);
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
