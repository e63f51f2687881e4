#include <gtest/gtest.h>

#include "node/stepped_time.h"

namespace spherical_springs {
namespace {

TEST(SteppedTime, IsThatOfTheSteps) {
  SteppedTime time(0.5);
  EXPECT_EQ(time.add(0), 0);
  EXPECT_EQ(time.add(10), 5);
  EXPECT_EQ(time.add(10), 0);
  EXPECT_EQ(time.add(11), 0.5);
  EXPECT_EQ(time.total(), 5.5);
}

TEST(SteppedTime, GoesOnWhereAScenesStepsBeginAgain) {
  SteppedTime time(0.5);
  time.add(10);
  EXPECT_EQ(time.add(0), 0);
  EXPECT_EQ(time.add(10), 5);
  EXPECT_EQ(time.add(4), 2) << "begun again, and 4 steps since";
  EXPECT_EQ(time.total(), 12);
}

}  // namespace
}  // namespace spherical_springs
