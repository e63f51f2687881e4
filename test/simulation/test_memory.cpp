// Memory that runs out at any allocation of a call leaves everything as it was.
#include <gtest/gtest.h>

#include <functional>
#include <new>
#include <sstream>
#include <thread>

#include "simulation/runner.h"
#include "spherical_springs/simulation.h"
#include "support/failing_malloc.h"
#include "support/relaxation_scenes.h"

namespace spherical_springs::core {
namespace {

using testing::ShortOfMemory;

SpringIds allIds(const Scene& scene) {
  SpringIds ids;
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    const auto& all = scene.springs<Spring>().ids();
    ids.get<Spring>().assign(all.begin(), all.end());
  });
  return ids;
}

class OutOfMemory : public ::testing::Test {
 protected:
  using Change = std::function<void(Simulation&)>;

  /// Everything that a scene is, to the last bit, and the next ids.
  std::string bitsOf(const Simulation& simulation) {
    std::ostringstream text;
    for (const Scene& scene : {simulation.scene(), simulation.presentScene()}) {
      writeScene(text, scene, simulation.state().time);
      text << scene.particles().nextId();
      forEachKind([&](auto kind) {
        text << ' ' << scene.springs<typename decltype(kind)::type>().nextId();
      });
    }
    text << simulation.state().steps << ' ' << simulation.state().positions.cols();
    return text.str();
  }

  /// Lets the first allocation of a change fail, then the second, until it succeeds.
  void expectAllOrNothing(const Change& change) {
    int failures = 0;
    for (bool succeeded = false; !succeeded; ++failures) {
      Simulation simulation({});
      simulation.addParticles(random_.particles().items());
      simulation.addSprings(testing::springsOf(random_));
      for (int i = 0; i < 5; ++i) simulation.step();
      const std::string before = bitsOf(simulation);
      try {
        testing::allocations_left = failures;
        change(simulation);
        testing::allocations_left = -1;
        succeeded = true;
        EXPECT_NE(bitsOf(simulation), before);
      } catch (const std::bad_alloc&) {
        ASSERT_EQ(bitsOf(simulation), before) << "at allocation " << failures;
        simulation.step();
      }
    }
    EXPECT_GT(failures, 1) << "nothing failed";
  }

  const Scene random_ = testing::randomScene(1, 10, 15, 0.1, 1);
};

TEST_F(OutOfMemory, WhileParticlesAreAdded) {
  expectAllOrNothing([this](Simulation& s) { s.addParticles(random_.particles().items()); });
}

TEST_F(OutOfMemory, WhileParticlesAreSet) {
  expectAllOrNothing([](Simulation& s) {
    s.setParticles({3, 5}, {testing::particleAt({1, 0, 0}), testing::particleAt({0, 1, 0})});
  });
}

TEST_F(OutOfMemory, WhileParticlesAreRemoved) {
  expectAllOrNothing([](Simulation& s) { s.removeParticles({2, 7}); });
}

TEST_F(OutOfMemory, WhileSpringsAreAdded) {
  expectAllOrNothing([this](Simulation& s) { s.addSprings(testing::springsOf(random_)); });
}

TEST_F(OutOfMemory, WhileSpringsAreSet) {
  SpringLists stiffer = testing::springsOf(random_);
  stiffer.get<AngleSpring>()[4].stiffness = 7;
  const SpringIds ids = allIds(random_);
  expectAllOrNothing([&](Simulation& s) { s.setSprings(ids, stiffer); });
}

TEST_F(OutOfMemory, WhileSpringsAreRemoved) {
  const SpringIds ids = allIds(random_);
  expectAllOrNothing([&](Simulation& s) { s.removeSprings(ids); });
}

TEST_F(OutOfMemory, WhileASceneIsReset) {
  expectAllOrNothing([](Simulation& s) { s.reset(); });
}

TEST_F(OutOfMemory, WhileASceneIsLoaded) {
  expectAllOrNothing([this](Simulation& s) { s.load({testing::randomScene(2, 20, 5), 3.}); });
}

struct Stepping {
  IntegrationMethod method;
  int threads;
  double spring_damping, particle_damping;
};

void PrintTo(const Stepping& stepping, std::ostream* out) {
  *out << "method " << static_cast<int>(stepping.method) << " on " << stepping.threads
       << " threads, damping " << stepping.spring_damping << " and " << stepping.particle_damping;
}

class SteppingShortOfMemory : public ShortOfMemory, public ::testing::WithParamInterface<Stepping> {
 protected:
  static constexpr int kSteps = 2;

  /// Large enough that threads share the loops over it.
  static Scene scene() {
    const Scene still = testing::randomScene(1, 1200, 1500, GetParam().spring_damping, 1);
    auto particles = still.particles().items();
    for (Particle& particle : particles) particle.damping = GetParam().particle_damping;
    return testing::sceneOf(particles, testing::springsOf(still));
  }

  static Simulation simulation() {
    Simulation::Settings settings;
    settings.method = GetParam().method;
    settings.system.threads = GetParam().threads;
    Simulation simulation(settings);
    simulation.load({scene(), 0});
    return simulation;
  }

  static void expectSame(const State& state, const State& before, const std::string& where) {
    ASSERT_EQ(state.positions, before.positions) << where;
    ASSERT_EQ(state.angular_velocities, before.angular_velocities) << where;
    ASSERT_EQ(state.steps, before.steps) << where;
    ASSERT_EQ(state.dissipated, before.dissipated) << where;
  }
};

TEST_P(SteppingShortOfMemory, ChangesNothingAndGoesOn) {
  Simulation undisturbed = simulation();
  const State start = undisturbed.state();
  undisturbed.step(kSteps);
  for (const bool for_good : {false, true}) {
    Simulation disturbed = simulation();
    const auto step = [&] { disturbed.step(kSteps); };
    const int failures = failAgainAndAgain(for_good, step, [&](const std::string& where) {
      expectSame(disturbed.state(), start, where);
    });
    EXPECT_GT(failures, 10);
    expectSame(disturbed.state(), undisturbed.state(), "at the end");
  }
}

// A step of a simulation that has stepped before needs no memory of a thread that has not.
TEST_P(SteppingShortOfMemory, ChangesNothingOnANewThread) {
  Simulation undisturbed = simulation(), disturbed = simulation();
  undisturbed.step(kSteps);
  disturbed.step(kSteps);
  const auto step = [&] { std::thread([&] { disturbed.step(kSteps); }).join(); };
  bool failed = false;
  std::thread([&] { failed = fails(0, true, [&] { disturbed.step(kSteps); }); }).join();
  if (failed) {
    expectSame(disturbed.state(), undisturbed.state(), "after a failure");
    step();
  }
  undisturbed.step(kSteps);
  expectSame(disturbed.state(), undisturbed.state(), "at the end");
}

INSTANTIATE_TEST_SUITE_P(OfEachKind, SteppingShortOfMemory,
                         ::testing::Values(Stepping{IntegrationMethod::verlet, 1, 0, 0},
                                           Stepping{IntegrationMethod::verlet, 2, 0, 0},
                                           Stepping{IntegrationMethod::verlet, 2, 0, 0.3},
                                           Stepping{IntegrationMethod::euler, 2, 0.3, 0},
                                           Stepping{IntegrationMethod::verlet, 2, 1e4, 1e4},
                                           Stepping{IntegrationMethod::fourth_order, 2, 1e4, 0.3},
                                           Stepping{IntegrationMethod::implicit_euler, 2, 0.3,
                                                    0.3}));

struct Relaxing {
  RelaxationMethod method;
  int level;  ///< of the mesh: 4 is large enough that threads share the loops over it
};

void PrintTo(const Relaxing& relaxing, std::ostream* out) {
  *out << "method " << static_cast<int>(relaxing.method) << ", level " << relaxing.level;
}

class RunnerShortOfMemory : public ShortOfMemory, public ::testing::WithParamInterface<Relaxing> {
 protected:
  RunnerShortOfMemory() {
    runner_.change([](Simulation& s) { s.load({testing::membraneScene(GetParam().level), 0}); });
  }

  static Simulation::Settings settings() {
    Simulation::Settings settings;
    settings.system.threads = 2;
    return settings;
  }

  static RelaxationOptions options(double tolerance = 0) {
    RelaxationOptions options;
    options.method = GetParam().method;
    options.tolerance = tolerance;
    return options;
  }

  Points positions() {
    return runner_.read([](const Simulation& s) { return s.state().positions; });
  }

  Runner runner_{settings(), false};
};

TEST_P(RunnerShortOfMemory, RelaxesAllOrNothing) {
  const Points start = positions();
  ASSERT_TRUE(runner_.relax(options()).converged);
  const Points end = positions();
  for (const bool for_good : {false, true}) {
    runner_.change([](Simulation& s) { s.reset(); });
    const auto relax = [&] { runner_.relax(options()); };
    const int failures = failAgainAndAgain(for_good, relax, [&](const std::string& where) {
      ASSERT_EQ(positions(), start) << where;
      ASSERT_EQ(runner_.snapshot().activity, Activity::none);
    });
    EXPECT_GT(failures, 20);
    EXPECT_EQ(positions(), end);
  }
}

TEST_P(RunnerShortOfMemory, TakesASnapshotOrNone) {
  const Points start = positions();
  runner_.change([](Simulation& s) { s.reset(); });
  const int failures = failAgainAndAgain(
      true, [&] { runner_.snapshot(); },
      [&](const std::string& where) { ASSERT_EQ(positions(), start) << where; });
  EXPECT_GT(failures, 5);
}

INSTANTIATE_TEST_SUITE_P(OfEachMethod, RunnerShortOfMemory,
                         ::testing::Values(Relaxing{RelaxationMethod::newton, 4},
                                           Relaxing{RelaxationMethod::newton, 1},
                                           Relaxing{RelaxationMethod::dynamics, 1},
                                           Relaxing{RelaxationMethod::fire, 1}));

// A call whose answer cannot be copied ends its relaxation all the same.
TEST(CancelledShortOfMemory, GoesOn) {
  Runner runner({}, false);
  runner.change([](Simulation& s) { s.load({testing::membraneScene(2), 0}); });
  const auto positions = [&] {
    return runner.read([](const Simulation& s) { return s.state().positions; });
  };
  const Points start = positions();
  RelaxationOptions endless;
  endless.method = RelaxationMethod::dynamics;
  endless.tolerance = 1e-300;
  bool threw = false;
  std::thread caller([&] {
    testing::is_victim = true;
    try {
      runner.relax(endless);
    } catch (const std::bad_alloc&) {
      threw = true;
    }
  });
  while (runner.snapshot().state.positions == start) std::this_thread::yield();
  testing::victims_fail = true;
  runner.cancel();
  caller.join();
  testing::victims_fail = false;
  EXPECT_TRUE(threw);
  EXPECT_EQ(positions(), start);
  EXPECT_TRUE(runner.relax({}).converged);
}

TEST(Memory, OfASceneIsGivenBackWhenItIsCleared) {
  Scene scene = testing::randomScene(1, 10, 15, 0.1, 1);
  scene.clear();
  const auto expectNone = [](const auto& table) {
    EXPECT_EQ(0u, table.ids().capacity());
    EXPECT_EQ(0u, table.items().capacity());
  };
  expectNone(scene.particles());
  forEachKind([&](auto kind) { expectNone(scene.springs<typename decltype(kind)::type>()); });
}

}  // namespace
}  // namespace spherical_springs::core
