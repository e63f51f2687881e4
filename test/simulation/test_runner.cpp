#include <gtest/gtest.h>

#include <future>
#include <new>
#include <thread>

#include "simulation/runner.h"
#include "support/scenes.h"

namespace spherical_springs::core {
namespace {

void fill(Runner& runner, const Scene& scene) {
  runner.change([&](Simulation& s) {
    s.addParticles(scene.particles().items());
    s.addSprings(testing::springsOf(scene));
  });
}

/// Adds a scene to one whose ids, like its own, are counted from 0.
void addBeside(Runner& runner, const Scene& scene) {
  runner.change([&](Simulation& s) {
    const std::vector<std::uint32_t> ids = s.addParticles(scene.particles().items());
    SpringLists springs = testing::springsOf(scene);
    forEachKind([&](auto kind) {
      for (auto& spring : springs.get<typename decltype(kind)::type>()) {
        for (std::uint32_t& particle : spring.particles) particle = ids[particle];
      }
    });
    s.addSprings(springs);
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
  EXPECT_THROW(runner_.change([](Simulation& s) { s.clear(); }), Refusal);
  EXPECT_THROW(runner_.setRunning(true), Refusal);
  EXPECT_THROW(runner_.step(1), Refusal);
  EXPECT_THROW(runner_.relax({}), Refusal);
  EXPECT_EQ(runner_.advance(0.01, 1).duration, 0.01);
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
  EXPECT_THROW(runner_.step(1), Refusal);
  EXPECT_THROW(runner_.relax({}), Refusal);
  EXPECT_EQ(runner_.read([](const Simulation& s) { return s.scene().particles().size(); }), 100);
}

TEST(Runner, StepsExactlyWhilePausedOnly) {
  Runner runner({}, true);
  EXPECT_THROW(runner.step(3), Refusal);
  runner.setRunning(false);
  EXPECT_EQ(runner.step(3), 3);
  EXPECT_EQ(runner.snapshot().state.steps, 3);
  EXPECT_EQ(runner.advance(0.003, 1).duration, 0.003);
  runner.setRunning(true);
  EXPECT_NEAR(runner.advance(0.003, 1).duration, 0, 1e-15);
}

TEST_P(BusyRunner, RefusesToGoOnWithAStepByOtherSteps) {
  const auto change = [&] { runner_.stepBy({IntegrationMethod::euler, 0.01}); };
  if (GetParam() == Activity::stepping) {
    EXPECT_THROW(change(), Refusal);
    EXPECT_EQ(runner_.snapshot().choice.method, IntegrationMethod::verlet);
    EXPECT_EQ(runner_.snapshot().choice.time_step, 0.001);
  } else {
    change();
    EXPECT_EQ(runner_.snapshot().choice.method, IntegrationMethod::euler);
    EXPECT_EQ(runner_.snapshot().choice.time_step, 0.01);
  }
  const auto now = runner_.snapshot();
  EXPECT_THROW(runner_.stepBy({now.choice.method, 1}, true), Refusal);
  EXPECT_EQ(runner_.snapshot().choice.time_step, now.choice.time_step);
  runner_.stepBy({now.choice.method, now.choice.time_step}, false);  // as it is
  runner_.cancel();
  work_.get();
}

// Nobody can change the scene between the steps and their undoing.
TEST(Runner, UndoesStepsThatCannotBeReportedBeforeAnyoneChangesTheScene) {
  Runner runner({}, false);
  fill(runner, testing::randomScene(3, 20, 30));
  runner.step(3);
  const State before = runner.snapshot().state;
  const auto report = [&] {
    EXPECT_EQ(runner.snapshot().state.steps, 8);
    EXPECT_NE(runner.snapshot().state.positions, before.positions);
    EXPECT_THROW(runner.change([](Simulation& s) { s.clear(); }), Refusal);
    EXPECT_EQ(runner.advance(0.001, 1).duration, 0.001);
    throw std::bad_alloc();
  };
  EXPECT_THROW(runner.step(5, report), std::bad_alloc);
  const State after = runner.snapshot().state;
  EXPECT_EQ(after.steps, before.steps);
  EXPECT_EQ(after.time, before.time);
  EXPECT_EQ(after.positions, before.positions);
  EXPECT_EQ(after.angular_velocities, before.angular_velocities);
  runner.change([](Simulation& s) { s.clear(); });
}

// So are they where the caller has cancelled them, after which the particles are at rest.
TEST(Runner, UndoesCancelledStepsThatCannotBeReported) {
  Runner runner({}, false);
  fill(runner, testing::randomScene(3, 20, 30));
  runner.step(3);
  const State before = runner.snapshot().state;
  auto work = std::async(std::launch::async, [&] {
    runner.step(~std::uint64_t(0), [&] {
      EXPECT_TRUE(runner.snapshot().state.angular_velocities.isZero(0));
      throw std::bad_alloc();
    });
  });
  while (!runner.cancel()) std::this_thread::yield();
  EXPECT_THROW(work.get(), std::bad_alloc);
  const State after = runner.snapshot().state;
  EXPECT_EQ(after.steps, before.steps);
  EXPECT_EQ(after.positions, before.positions);
  EXPECT_EQ(after.angular_velocities, before.angular_velocities);
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

/// Particles joined by many springs at random, which take long to relax.
Scene knot(std::uint32_t particles) {
  return testing::randomScene(6, particles, 3 * static_cast<int>(particles), 0, 0);
}

// A relaxation that is cancelled before its first iteration tells where the particles are.
TEST(Runner, CancelledAtOnceTellsEnergyAndTorque) {
  Runner runner({}, false);
  fill(runner, knot(4000));
  const auto start = runner.snapshot();
  const double energy = energies(*start.plan, start.state).potential();
  const double torque = maxTorque(*start.plan, start.state);
  for (int i = 0; i < 6; ++i) {
    auto answer = std::async(std::launch::async, [&] { return runner.relax({}); });
    while (!runner.cancel()) std::this_thread::yield();
    const RelaxationResult result = answer.get();
    EXPECT_FALSE(result.converged);
    EXPECT_EQ(result.message.rfind("cancelled; largest torque", 0), 0) << result.message;
    EXPECT_NEAR(result.energy_before, energy, 1e-9 * energy);
    EXPECT_LE(result.energy_after, (1 + 1e-9) * energy);
    EXPECT_GT(result.max_torque, 1e-6 * torque);
    runner.change([](Simulation& s) { s.reset(); });
  }
}

/// Whether no turn of the whole would bring `after` nearer to `before`.
bool lieAsNearAsTheyCan(const Points& before, const Points& after) {
  const Eigen::Matrix3d moments = after * before.transpose();
  return (moments - moments.transpose()).norm() < 1e-9 * moments.norm();
}

TEST(Runner, DoesNotTurnTheWholeWhenCancelled) {
  for (const auto method : {RelaxationMethod::newton, RelaxationMethod::dynamics}) {
    Runner runner({}, false);
    fill(runner, knot(300));
    const Points start = runner.snapshot().state.positions;
    RelaxationOptions options;
    options.method = method;
    options.tolerance = 1e-300;
    auto answer = std::async(std::launch::async, [&] { return runner.relax(options); });
    const auto moved = [&] {
      return (runner.snapshot().state.positions - start).cwiseAbs().maxCoeff() > 0.1;
    };
    while (!moved()) std::this_thread::yield();
    runner.cancel();
    const RelaxationResult result = answer.get();
    EXPECT_TRUE(lieAsNearAsTheyCan(start, result.positions)) << result.message;
    EXPECT_EQ(runner.snapshot().state.positions, result.positions);
  }
}

TEST(Runner, KeepsTheBitsOfWhatWasRelaxedWhenCancelled) {
  const auto start =
      std::vector<Particle>{testing::particleAt({1, 0, 0}), testing::particleAt({0, 1, 0})};
  for (const auto method : {RelaxationMethod::dynamics, RelaxationMethod::fire}) {
    Runner runner({}, false);
    std::vector<std::uint32_t> pair;
    runner.change([&](Simulation& s) {
      pair = s.addParticles(start);
      SpringLists springs;
      AngleSpring spring;
      spring.particles = {pair[0], pair[1]};
      spring.rest_angle = kPi / 2 + 3e-10;
      spring.stiffness = 1;
      springs.get<AngleSpring>().push_back(spring);
      s.addSprings(springs);
    });
    addBeside(runner, knot(300));
    const Points before = runner.snapshot().state.positions;
    RelaxationOptions options;
    options.method = method;
    auto answer = std::async(std::launch::async, [&] { return runner.relax(options); });
    const auto moved = [&] {
      return (runner.snapshot().state.positions - before).cwiseAbs().maxCoeff() > 0.1;
    };
    while (!moved()) std::this_thread::yield();
    runner.cancel();
    EXPECT_EQ(answer.get().positions.leftCols(2), before.leftCols(2));
  }
}

TEST(Runner, ShowsARelaxationUnderWayWithoutTouchingTheScene) {
  Runner runner({}, false);
  fill(runner, knot(300));
  const Points start = runner.snapshot().state.positions;
  RelaxationOptions options;
  options.method = RelaxationMethod::dynamics;
  options.tolerance = 1e-300;
  auto answer = std::async(std::launch::async, [&] { return runner.relax(options); });
  while (runner.snapshot().state.positions == start) std::this_thread::yield();
  EXPECT_EQ(runner.read([](const Simulation& s) { return s.state().positions; }), start);
  runner.cancel();
  answer.get();
}

TEST(Runner, KeepsNothingOfASceneThatWasRelaxedAndCleared) {
  Runner runner({}, false);
  fill(runner, testing::randomScene(3, 20, 30));
  const std::weak_ptr<const System> system = runner.snapshot().plan->system();
  runner.relax({});
  EXPECT_FALSE(system.expired());
  runner.change([](Simulation& s) { s.clear(); });
  EXPECT_TRUE(system.expired());
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

}  // namespace
}  // namespace spherical_springs::core
