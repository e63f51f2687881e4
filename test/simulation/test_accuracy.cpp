// Steps that are chosen for an accuracy: the error got against the error asked for, and when they
// are chosen anew.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <ostream>
#include <stdexcept>
#include <string>

#include "simulation/runner.h"
#include "spherical_springs/measures.h"
#include "support/relaxation_scenes.h"
#include "support/scenes.h"

namespace spherical_springs::core {
namespace {

Simulation::Settings settingsFor(double accuracy, int threads = 1) {
  Simulation::Settings settings;
  settings.accuracy = accuracy;
  settings.chooses_method = true;
  settings.system.threads = threads;
  return settings;
}

/// Three particles with three arcs, far from rest.
Scene arcScene(double damping, double stiffest) {
  std::vector<Particle> particles = {testing::particleAt({1, 0.15, 0.05}),
                                     testing::particleAt({0.9, 0.5, 0.1}),
                                     testing::particleAt({0.9, 0.1, 0.5})};
  for (Particle& particle : particles) particle.damping = damping;
  SpringLists springs = testing::threeArcs();
  springs.get<AngleSpring>()[0].stiffness = stiffest;
  return testing::sceneOf(particles, springs);
}

/// A pair that swings by 0.3 rad at sqrt(2) rad/s.
Scene pairScene() {
  return testing::sceneOf(
      {testing::particleAt({1, 0, 0}), testing::particleAt({std::cos(1.3), std::sin(1.3), 0})},
      testing::arcs({testing::angleSpring(0, 1, 1)}));
}

struct Asked {
  const char* scene;
  double accuracy;  // [rad/s]
};

void PrintTo(const Asked& asked, std::ostream* out) { *out << asked.scene << asked.accuracy; }

class Accuracy : public ::testing::TestWithParam<Asked> {
 protected:
  static Scene scene() {
    const std::string name = GetParam().scene;
    if (name == "pair") return pairScene();
    if (name == "damped") return arcScene(0.5, 1);
    if (name == "stiff") return arcScene(0, 1e4);
    return testing::membraneScene(1);
  }

  /// Largest distance from a trajectory of steps that are much shorter, over particles and steps of
  /// `duration` [s], by that [rad/s].
  double errorRateOf(const StepChoice& choice, double duration) const {
    constexpr int kShorter = 16;
    const auto tested = makeIntegrator(plan_, choice.method, choice.time_step);
    const auto exact =
        makeIntegrator(plan_, IntegrationMethod::fourth_order, choice.time_step / kShorter);
    State by_tested = start_, by_exact = start_;
    tested->take(start_);
    exact->take(start_);
    double largest = 0;
    while (by_tested.time < duration) {
      tested->advance(1);
      exact->advance(kShorter);
      tested->give(by_tested);
      exact->give(by_exact);
      largest =
          std::max(largest, (by_tested.positions - by_exact.positions).colwise().norm().maxCoeff());
    }
    return largest / by_tested.time;
  }

  const Scene scene_ = scene();
  const std::shared_ptr<const Plan> plan_ = std::make_shared<const Plan>(scene_, System::Options());
  const State start_ = testing::stateOf(scene_);
};

TEST_P(Accuracy, GotIsWithinAFactorOf5OfAsked) {
  const double asked = GetParam().accuracy;
  Simulation simulation(settingsFor(asked));
  simulation.load({scene_, 0});
  const StepChoice choice = simulation.choice();
  const double stable = stableTimeStep(*plan_->system(), choice.method, start_.positions);
  const double window =
      16 * stableTimeStep(*plan_->system(), IntegrationMethod::verlet, start_.positions);
  const double got = errorRateOf(choice, 1.25 * window);
  EXPECT_LT(got, 5 * asked);
  if (choice.time_step < 0.7 * stable) {
    EXPECT_GT(got, asked / 5);
  }
  EXPECT_LT(choice.time_step, 0.8 * stable);
  EXPECT_TRUE(choice.is_reached);
  EXPECT_LT(choice.error_rate, 1.01 * asked);
}

std::vector<Asked> allAsked() {
  std::vector<Asked> all;
  for (const char* scene : {"pair", "damped", "stiff", "mesh"}) {
    for (const double accuracy : {1e-3, 1e-5, 1e-7, 1e-9}) all.push_back({scene, accuracy});
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(OfScenes, Accuracy, ::testing::ValuesIn(allAsked()));

TEST(AccuracyChoice, TakesTheMethodThatIsCheaper) {
  const auto methodFor = [](double accuracy) {
    Simulation simulation(settingsFor(accuracy));
    simulation.load({testing::membraneScene(1), 0});
    return simulation.choice().method;
  };
  EXPECT_EQ(methodFor(1e-2), IntegrationMethod::verlet);
  EXPECT_EQ(methodFor(1e-8), IntegrationMethod::fourth_order);
}

TEST(AccuracyChoice, KeepsTheMethodThatIsAskedFor) {
  Simulation::Settings settings = settingsFor(1e-4);
  settings.chooses_method = false;
  for (const IntegrationMethod method :
       {IntegrationMethod::euler, IntegrationMethod::verlet, IntegrationMethod::fourth_order,
        IntegrationMethod::implicit_euler}) {
    settings.method = method;
    Simulation simulation(settings);
    simulation.load({pairScene(), 0});
    EXPECT_EQ(simulation.choice().method, method);
    EXPECT_LT(simulation.choice().error_rate, 1e-4);
    EXPECT_GT(simulation.choice().error_rate, 1e-5);
  }
}

TEST(AccuracyChoice, OfWhatIsAtRestIsAShareOfTheStableStep) {
  Simulation simulation(settingsFor(1e-9));
  simulation.load(
      {testing::sceneOf({testing::particleAt({1, 0, 0}), testing::particleAt({0, 1, 0})},
                        testing::arcs({testing::angleSpring(0, 1, kPi / 2)})),
       0});
  const double stable = stableTimeStep(*simulation.plan()->system(), simulation.choice().method,
                                       simulation.state().positions);
  EXPECT_DOUBLE_EQ(simulation.choice().time_step, 0.75 * stable);
}

TEST(AccuracyChoice, IsTheTimeStepAskedForWhereNothingMoves) {
  Simulation simulation(settingsFor(1e-9));
  EXPECT_EQ(simulation.choice().time_step, 0.001);
  simulation.addParticles({testing::particleAt({1, 0, 0})});
  EXPECT_EQ(simulation.choice().time_step, 0.001);
  Particle turning = testing::particleAt({1, 0, 0});
  turning.angular_velocity = Vector3(0, 0, 4);
  turning.damping = 0.1;
  simulation.setParticles({0}, {turning});
  EXPECT_GT(simulation.choice().time_step, 0.001);
  turning.pinned = true;
  simulation.setParticles({0}, {turning});
  EXPECT_EQ(simulation.choice().time_step, 0.001);
  simulation.step(3);
  EXPECT_EQ(simulation.state().steps, 3);
}

TEST(AccuracyChoice, IsTheBestThereIsWhereRoundingAllowsNoBetter) {
  for (const bool chooses_method : {true, false}) {
    Simulation::Settings settings = settingsFor(1e-17);
    settings.chooses_method = chooses_method;
    Simulation simulation(settings);
    simulation.load({arcScene(0, 1), 0});
    EXPECT_FALSE(simulation.choice().is_reached);
    EXPECT_GT(simulation.choice().error_rate, 1e-15);
    EXPECT_LT(simulation.choice().error_rate, 1e-12);
    EXPECT_GT(simulation.choice().time_step, 1e-8);
  }
}

TEST(AccuracyChoice, IsMadeAnewWhenTheSceneChanges) {
  Simulation simulation(settingsFor(1e-6));
  simulation.load({arcScene(0, 1), 0});
  simulation.step(10);
  const double before = simulation.choice().time_step;
  AngleSpring stiffer = simulation.scene().springs<AngleSpring>().item(0);
  stiffer.stiffness = 1e4;
  SpringIds ids;
  ids.get<AngleSpring>() = {0};
  simulation.setSprings(ids, testing::arcs({stiffer}));
  simulation.step(1);
  EXPECT_LT(simulation.choice().time_step, before / 20);
  EXPECT_EQ(simulation.state().steps, 11);
}

TEST(AccuracyChoice, IsMadeAnewWhenAnotherIsAskedFor) {
  Simulation simulation(settingsFor(1e-4));
  simulation.load({arcScene(0, 1), 0});
  simulation.step(10);
  const State before = simulation.state();
  const double step = simulation.choice().time_step;
  simulation.stepBy({IntegrationMethod::verlet, 1, 1e-8, true});
  EXPECT_LT(simulation.choice().time_step, step);
  EXPECT_EQ(simulation.state().positions, before.positions);
  EXPECT_EQ(simulation.state().time, before.time);
  simulation.stepBy({IntegrationMethod::euler, 0.25});
  EXPECT_EQ(simulation.choice().time_step, 0.25);
  simulation.step(1);
  EXPECT_NEAR(simulation.state().time, before.time + 0.25, 1e-12);
}

/// Steps up to the next review, and through it.
void review(Simulation& simulation) { simulation.step(simulation.choice().steps_to_review + 1); }

TEST(AccuracyReview, KeepsStepsThatAreAboutAsExactAsAskedFor) {
  for (const Scene& scene : {pairScene(), testing::membraneScene(1)}) {
    Simulation simulation(settingsFor(1e-6));
    simulation.load({scene, 0});
    const StepChoice first = simulation.choice();
    for (int i = 0; i < 10; ++i) {
      review(simulation);
      EXPECT_EQ(simulation.choice().time_step, first.time_step) << i;
      EXPECT_EQ(simulation.choice().method, first.method) << i;
    }
  }
}

TEST(AccuracyReview, TakesLongerStepsOfASceneThatComesToRest) {
  Simulation simulation(settingsFor(1e-7));
  simulation.load({arcScene(0.5, 1), 0});
  const double first = simulation.choice().time_step;
  review(simulation);
  EXPECT_GT(simulation.choice().time_step, 2 * first);
}

TEST(AccuracyReview, TakesShorterStepsWhereTheseAreNotExactEnough) {
  Simulation simulation(settingsFor(1e-6));
  simulation.load({pairScene(), 0});
  const double exact = simulation.choice().time_step;
  Simulation::Moment moment = simulation.moment();
  moment.choice.time_step = 3 * exact;
  simulation.restore(moment);
  review(simulation);
  EXPECT_NEAR(simulation.choice().time_step, exact, 0.2 * exact);
}

/// Steps as in `parts`, and looks in between; returns the end.
State steppedIn(std::initializer_list<std::uint64_t> parts, int threads, const Scene& scene) {
  Simulation simulation(settingsFor(1e-5, threads));
  simulation.load({scene, 0});
  for (const std::uint64_t part : parts) {
    simulation.step(part);
    simulation.state();
    simulation.choice();
  }
  return simulation.state();
}

TEST(AccuracyReview, GivesTheSameBitsHoweverStepsAreCut) {
  const Scene scene = arcScene(0.1, 1);
  Simulation simulation(settingsFor(1e-5));
  simulation.load({scene, 0});
  const std::uint64_t first = simulation.choice().steps_to_review;
  const double step = simulation.choice().time_step;
  const State at_once = steppedIn({2 * first + 10}, 1, scene);
  EXPECT_GT(at_once.time, 1.1 * step * (2 * first + 10)) << "the step has not changed";
  const State in_parts = steppedIn({1, first - 1, 1, first - 2, 3, 8}, 1, scene);
  EXPECT_EQ(at_once.positions, in_parts.positions);
  EXPECT_EQ(at_once.angular_velocities, in_parts.angular_velocities);
  EXPECT_EQ(at_once.time, in_parts.time);
}

TEST(AccuracyReview, GivesTheSameBitsForAnyNumberOfThreads) {
  const Scene scene = testing::membraneScene(4);
  const State by_one = steppedIn({300, 900}, 1, scene);
  const State by_two = steppedIn({1200}, 2, scene);
  EXPECT_EQ(by_one.positions, by_two.positions);
  EXPECT_EQ(by_one.time, by_two.time);
}

TEST(AccuracyWish, IsRefusedWhereItMeansNothing) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Simulation simulation(settingsFor(1e-6));
  const StepChoice before = simulation.choice();
  for (const double accuracy : {-1., kNaN, kInfinity, -kInfinity}) {
    EXPECT_THROW(simulation.stepBy({IntegrationMethod::verlet, 1, accuracy}),
                 std::invalid_argument);
    EXPECT_THROW(Simulation(settingsFor(accuracy)), std::invalid_argument);
  }
  EXPECT_THROW(simulation.stepBy({IntegrationMethod::verlet, 1, 0, true}), std::invalid_argument);
  EXPECT_EQ(simulation.settings().accuracy, 1e-6);
  EXPECT_EQ(simulation.choice().time_step, before.time_step);
}

TEST(AccuracyOfARunner, EndsWhereADurationDoesThoughTheStepChanges) {
  Runner runner(settingsFor(1e-7), false);
  runner.change([](Simulation& s) { s.load({arcScene(0.5, 1), 0}); });
  const StepChoice first = runner.choice();
  const double duration = first.time_step * first.steps_to_review + 10.3;
  const auto rest = [&](double time_step, const Runner::Done& done) {
    return static_cast<std::uint64_t>(std::round((duration - done.time) / time_step));
  };
  const Runner::Done done = runner.step(rest, [] {});
  const auto end = runner.snapshot();
  EXPECT_GT(end.choice.time_step, 2 * first.time_step);
  EXPECT_NEAR(end.state.time, duration, 0.51 * end.choice.time_step);
  EXPECT_NEAR(done.time, end.state.time, 1e-9);
  EXPECT_EQ(done.steps, end.state.steps);
  EXPECT_EQ(runner.step(100), 100);
}

TEST(AccuracyOfARunner, FollowsTheClockThoughTheStepChanges) {
  Runner runner(settingsFor(1e-7), true);
  runner.change([](Simulation& s) { s.load({arcScene(0.5, 1), 0}); });
  const StepChoice first = runner.choice();
  const double tick = first.time_step * (first.steps_to_review / 30 + 0.3);
  double left = 0;
  for (int i = 0; i < 40; ++i) left = runner.advance(left + tick, 1).duration;
  const auto end = runner.snapshot();
  EXPECT_GT(end.choice.time_step, 2 * first.time_step);
  EXPECT_NEAR(end.state.time + left, 40 * tick, 1e-9);
  EXPECT_LT(left, end.choice.time_step);
  EXPECT_NEAR(end.stepped_time, end.state.time, 1e-9);
}

}  // namespace
}  // namespace spherical_springs::core
