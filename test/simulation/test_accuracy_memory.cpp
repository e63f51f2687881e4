// Memory that runs out while steps are chosen or reviewed leaves everything as it was.
#include <gtest/gtest.h>

#include <string>

#include "spherical_springs/simulation.h"
#include "support/failing_malloc.h"
#include "support/scenes.h"

namespace spherical_springs::core {
namespace {

class AccuracyShortOfMemory : public testing::ShortOfMemory {
 protected:
  static Simulation::Settings settings() {
    Simulation::Settings settings;
    settings.accuracy = 1e-5;
    settings.chooses_method = true;
    return settings;
  }

  AccuracyShortOfMemory() { simulation_.load({testing::randomScene(1, 10, 8, 0.1, 1), 0}); }

  void expectSame(const StepChoice& choice, const State& state, const std::string& where) {
    ASSERT_EQ(simulation_.lastChoice().method, choice.method) << where;
    ASSERT_EQ(simulation_.lastChoice().time_step, choice.time_step) << where;
    ASSERT_EQ(simulation_.lastChoice().steps_to_review, choice.steps_to_review) << where;
    ASSERT_EQ(simulation_.state().steps, state.steps) << where;
    ASSERT_EQ(simulation_.state().positions, state.positions) << where;
  }

  Simulation simulation_{settings()};
};

TEST_F(AccuracyShortOfMemory, ReviewsAndStepsAllOrNothing) {
  simulation_.step(simulation_.choice().steps_to_review - 3);
  const State before = simulation_.state();
  const StepChoice choice = simulation_.lastChoice();
  ASSERT_EQ(choice.steps_to_review, 3);
  const int failures = failAgainAndAgain(
      true, [&] { simulation_.step(10); },
      [&](const std::string& where) { expectSame(choice, before, where); });
  EXPECT_GT(failures, 20);
  EXPECT_EQ(simulation_.state().steps, before.steps + 10);
}

TEST_F(AccuracyShortOfMemory, TakesAWishOrNone) {
  simulation_.step(5);
  const State before = simulation_.state();
  const StepChoice choice = simulation_.lastChoice();
  const int failures = failAgainAndAgain(
      true,
      [&] {
        simulation_.stepBy({IntegrationMethod::verlet, 1, 1e-8, true});
      },
      [&](const std::string& where) {
        expectSame(choice, before, where);
        ASSERT_EQ(simulation_.settings().accuracy, 1e-5) << where;
      });
  EXPECT_GT(failures, 20);
  EXPECT_EQ(simulation_.settings().accuracy, 1e-8);
  EXPECT_NE(simulation_.lastChoice().time_step, choice.time_step);
}

}  // namespace
}  // namespace spherical_springs::core
