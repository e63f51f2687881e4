#include <gtest/gtest.h>

#include "node/step_clock.h"

namespace spherical_springs {
namespace {

TEST(StepClock, CountsTimeByTheClock) {
  StepClock clock(1);
  EXPECT_DOUBLE_EQ(clock.due(0.25), 0.25);
  clock.keep(0.0625, 0.125);
  EXPECT_DOUBLE_EQ(clock.due(0.25), 0.3125);  // what was left of a step counts
  clock.keep(0, 0.125);
  EXPECT_EQ(clock.due(0), 0);
}

TEST(StepClock, FollowsTheRealTimeFactor) { EXPECT_EQ(StepClock(10).due(0.25), 2.5); }

TEST(StepClock, LeavesOutStepsThatWereNotDone) {
  StepClock clock(1);
  clock.keep(2.75, 0.5);
  EXPECT_EQ(clock.due(0), 0.25);
}

TEST(StepClock, GoesOnWithOtherNumbers) {
  StepClock clock(1);
  clock.keep(0.25, 0.5);
  clock.change(1, 2);
  EXPECT_EQ(clock.due(0.125), 0.5);
}

TEST(StepClock, MakesNoBurstOfALongStepThatWasDueInPart) {
  StepClock clock(1);
  clock.keep(0.75, 1);
  clock.change(1e-12, 1e6);
  EXPECT_LT(clock.due(0), 1e-12);
}

TEST(StepClock, NeitherGoesBackNorPilesUp) {
  const StepClock clock(1);
  EXPECT_EQ(clock.due(-100), 0);
  EXPECT_EQ(clock.due(100), 1);
}

}  // namespace
}  // namespace spherical_springs
