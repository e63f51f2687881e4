#include <gtest/gtest.h>

#include "node/lag.h"

namespace spherical_springs {
namespace {

TEST(Lag, IsThereWhenLessIsSimulatedThanDue) {
  Lag lag(2, 0.001);
  EXPECT_FALSE(lag.behind(true, 10, 0));
  EXPECT_FALSE(lag.behind(true, 11, 1.9));
  EXPECT_TRUE(lag.behind(true, 12, 3.5));
  EXPECT_TRUE(lag.behind(true, 12.1, 3.7)) << "too short to judge anew";
  EXPECT_FALSE(lag.behind(true, 13, 5.5));
}

TEST(Lag, IsNotThereWhilePaused) {
  Lag lag(1, 0.001);
  lag.behind(true, 10, 0);
  EXPECT_TRUE(lag.behind(true, 12, 1));
  EXPECT_FALSE(lag.behind(false, 14, 1));
  EXPECT_FALSE(lag.behind(true, 16, 1));
  EXPECT_FALSE(lag.behind(true, 17, 2));
}

TEST(Lag, IsNotThereWhenTimeOrTheClockGoesBack) {
  Lag lag(1, 0.001);
  lag.behind(true, 10, 5);
  EXPECT_FALSE(lag.behind(true, 12, 0));
  EXPECT_FALSE(lag.behind(true, 3, 1));
}

TEST(Lag, TakesNoStepThatIsYetToComeForOne) {
  Lag lag(1, 2);
  lag.behind(true, 10, 0);
  EXPECT_FALSE(lag.behind(true, 11.9, 0));
}

}  // namespace
}  // namespace spherical_springs
