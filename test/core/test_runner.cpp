#include <gtest/gtest.h>

#include <future>
#include <thread>

#include "scenes.h"
#include "spherical_springs/runner.h"

namespace spherical_springs::core {
namespace {

void fill(Runner& runner, const Scene& scene) {
  runner.change([&](Simulation& s) {
    s.addParticles(scene.particles().items());
    s.addSprings(testing::springsOf(scene));
  });
}

/// A runner in the middle of a relaxation or step that will not end by itself.
class BusyRunner : public ::testing::TestWithParam<Activity> {
 protected:
  void SetUp() override {
    fill(runner_, testing::randomScene(1, 100, 150));
    work_ = std::async(std::launch::async, [this] {
      if (GetParam() == Activity::stepping) {
        runner_.step(~std::uint64_t(0));
        return;
      }
      RelaxationOptions options;
      options.method = RelaxationMethod::dynamics;
      options.tolerance = 1e-300;
      runner_.relax(options);
    });
    while (runner_.snapshot().activity == Activity::none) std::this_thread::yield();
  }

  Runner runner_{Simulation::Settings(), false};
  std::future<void> work_;
};
INSTANTIATE_TEST_SUITE_P(Both, BusyRunner,
                         ::testing::Values(Activity::stepping, Activity::relaxing));

TEST_P(BusyRunner, AnswersReadersRefusesChangesAndEndsAtRest) {
  EXPECT_EQ(runner_.read([](const Simulation& s) { return s.scene().particles().size(); }), 100);
  EXPECT_THROW(runner_.change([](Simulation& s) { s.clear(); }), std::runtime_error);
  EXPECT_THROW(runner_.setRunning(true), std::runtime_error);
  EXPECT_THROW(runner_.step(1), std::runtime_error);
  EXPECT_THROW(runner_.relax({}), std::runtime_error);
  EXPECT_EQ(runner_.advance(10, 1), 0);
  EXPECT_EQ(runner_.snapshot().activity, GetParam());

  EXPECT_TRUE(runner_.cancel());
  work_.get();
  EXPECT_FALSE(runner_.cancel());
  const auto end = runner_.snapshot();
  EXPECT_EQ(end.activity, Activity::none);
  EXPECT_TRUE(end.state.angular_velocities.isZero(0));
  runner_.change([](Simulation& s) { s.clear(); });
}

TEST_P(BusyRunner, EndsWhenClosedAndBeginsNothingMore) {
  runner_.close();
  work_.get();
  EXPECT_THROW(runner_.step(1), std::runtime_error);
  EXPECT_THROW(runner_.relax({}), std::runtime_error);
  EXPECT_EQ(runner_.read([](const Simulation& s) { return s.scene().particles().size(); }), 100);
}

TEST(Runner, StepsExactlyWhilePausedOnly) {
  Runner runner({}, true);
  EXPECT_THROW(runner.step(3), std::runtime_error);
  runner.setRunning(false);
  EXPECT_EQ(runner.step(3), 3);
  EXPECT_EQ(runner.snapshot().state.steps, 3);
  EXPECT_EQ(runner.advance(3, 1), 0);
  runner.setRunning(true);
  EXPECT_EQ(runner.advance(3, 1), 3);
}

TEST(Runner, GivesTheSameBitsWhateverReadsBeside) {
  Points positions[2];
  for (const bool read : {false, true}) {
    Runner runner({}, false);
    fill(runner, testing::randomScene(2, 100, 150, 0.1, 1));
    std::atomic<bool> done{false};
    std::thread reader([&] {
      while (read && !done) runner.snapshot();
    });
    runner.step(500);
    done = true;
    reader.join();
    positions[read] = runner.snapshot().state.positions;
  }
  EXPECT_EQ(positions[0], positions[1]);
}

TEST(Runner, ABadRequestToRelaxChangesNothing) {
  Runner runner({}, false);
  fill(runner, testing::randomScene(3, 10, 10, 0, 1));
  runner.step(10);
  const auto before = runner.snapshot();
  RelaxationOptions options;
  options.tolerance = -1;
  EXPECT_THROW(runner.relax(options), std::invalid_argument);
  const auto after = runner.snapshot();
  EXPECT_EQ(before.state.angular_velocities, after.state.angular_velocities);
  EXPECT_EQ(before.account, after.account);
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

}  // namespace
}  // namespace spherical_springs::core
