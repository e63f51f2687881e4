#include <gtest/gtest.h>

#include <stdexcept>

#include "simulation/runner.h"
#include "support/scenes.h"

namespace spherical_springs::core {
namespace {

TEST(ChangingSteps, StepsByAnotherMethodAndTimeStepFromThere) {
  const Scene scene = testing::randomScene(3, 20, 30);
  Simulation::Settings settings;
  settings.method = IntegrationMethod::fourth_order;
  settings.time_step = 0.01;
  Runner runner({}, false), like_the_end(settings, false);
  runner.change([&](Simulation& s) {
    s.addParticles(scene.particles().items());
    s.addSprings(testing::springsOf(scene));
  });
  runner.step(50);
  const State middle = runner.snapshot().state;
  runner.stepBy({IntegrationMethod::fourth_order, 0.01});
  EXPECT_EQ(runner.snapshot().state.positions, middle.positions);
  EXPECT_EQ(runner.snapshot().state.angular_velocities, middle.angular_velocities);
  EXPECT_EQ(runner.snapshot().state.time, middle.time);
  like_the_end.change([&](Simulation& s) { s.load(runner.present()); });
  runner.step(20);
  like_the_end.step(20);
  const auto end = runner.snapshot();
  EXPECT_EQ(end.choice.method, IntegrationMethod::fourth_order);
  EXPECT_EQ(end.choice.time_step, 0.01);
  EXPECT_EQ(end.state.steps, 70);
  EXPECT_NEAR(end.state.time, 0.25, 1e-15);
  EXPECT_NEAR(end.stepped_time, 0.25, 1e-15);
  EXPECT_TRUE(end.state.positions.isApprox(like_the_end.snapshot().state.positions, 1e-12));
}

TEST(ChangingSteps, CountsTheTimeOfItsStepsWhateverBecomesOfTheScene) {
  Runner runner({}, false);
  runner.step(1000);
  runner.change([](Simulation& s) { s.clear(); });
  runner.stepBy({IntegrationMethod::verlet, 0.5});
  runner.step(2);
  EXPECT_NEAR(runner.snapshot().stepped_time, 2, 1e-12);
}

TEST(ChangingSteps, StepsForADurationWhateverTheStep) {
  Runner runner({}, true);
  EXPECT_NEAR(runner.advance(0.0034, 1).duration, 0.0004, 1e-15);
  runner.stepBy({IntegrationMethod::verlet, 10});
  EXPECT_EQ(runner.advance(9.5, 1).duration, 9.5);
  EXPECT_EQ(runner.advance(30.5, 1).duration, 0.5);
  EXPECT_EQ(runner.snapshot().state.steps, 6);
}

TEST(ChangingSteps, StepsWholeStepsWhateverRoundingSays) {
  Runner runner({}, true);
  runner.stepBy({IntegrationMethod::verlet, 0.1});
  EXPECT_NEAR(runner.advance(0.3, 1).duration, 0, 1e-15) << "which is 2.9999999999999996 steps";
  EXPECT_EQ(runner.snapshot().state.steps, 3);
}

TEST(ChangingSteps, ChangesAllOrNothingOfHowItSteps) {
  Runner runner({}, false);
  EXPECT_THROW(runner.stepBy({IntegrationMethod::euler, -1}, true), std::invalid_argument);
  EXPECT_FALSE(runner.isRunning());
  EXPECT_EQ(runner.snapshot().choice.method, IntegrationMethod::verlet);
  runner.stepBy({IntegrationMethod::euler, 1}, true);
  EXPECT_TRUE(runner.isRunning());
  runner.stepBy({IntegrationMethod::verlet, 1});
  EXPECT_TRUE(runner.isRunning());
}

TEST(ChangingSteps, CountsStepsByTheTimeStepThatTheyHave) {
  Runner runner({}, false);
  runner.stepBy({IntegrationMethod::verlet, 0.5});
  const auto aSecond = [](double time_step, const Runner::Done&) {
    return static_cast<std::uint64_t>(1 / time_step);
  };
  const Runner::Done done = runner.step(aSecond, [&] {
    EXPECT_THROW(runner.stepBy({IntegrationMethod::verlet, 1}), Refusal);
  });
  EXPECT_EQ(done.steps, 2);
  EXPECT_EQ(done.time, 1);
}

}  // namespace
}  // namespace spherical_springs::core
