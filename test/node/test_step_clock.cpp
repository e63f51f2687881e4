#include <gtest/gtest.h>

#include "node/step_clock.h"

namespace spherical_springs {
namespace {

TEST(StepClock, CountsStepsByTheClock) {
  StepClock clock(0.001, 1);
  EXPECT_EQ(clock.due(0.0104), 10u);
  EXPECT_EQ(clock.due(0.0107), 11u);  // what was left of a step counts
  EXPECT_EQ(clock.due(0), 0u);
}

TEST(StepClock, FollowsTheRealTimeFactor) { EXPECT_EQ(StepClock(0.5, 10).due(0.25), 5u); }

TEST(StepClock, WaitsForAStepLongerThanATick) {
  StepClock clock(0.04, 1);
  EXPECT_EQ(clock.due(0.03), 0u);
  EXPECT_EQ(clock.due(0.03), 1u);
}

TEST(StepClock, GoesOnWithOtherNumbers) {
  StepClock clock(0.5, 1);
  EXPECT_EQ(clock.due(0.25), 0u);
  clock.change(1, 2);
  EXPECT_EQ(clock.timeStep(), 1);
  EXPECT_EQ(clock.due(0.25), 0u) << "0.25 s are left, and 0.5 s more are due";
  EXPECT_EQ(clock.due(0.125), 1u);
}

TEST(StepClock, MakesNoBurstOfALongStepThatWasDueInPart) {
  StepClock clock(1, 1);
  EXPECT_EQ(clock.due(0.75), 0u);
  clock.change(1e-12, 1e6);
  EXPECT_EQ(clock.due(0), 0u);
}

TEST(StepClock, NeitherGoesBackNorPilesUp) {
  StepClock clock(0.5, 1);
  EXPECT_EQ(clock.due(-100), 0u);
  EXPECT_EQ(clock.due(100), 2u);
  EXPECT_EQ(clock.due(0.1), 0u);
  EXPECT_LE(StepClock(1e-12, 1e6).due(1), 1000000000000000u);
}

}  // namespace
}  // namespace spherical_springs
