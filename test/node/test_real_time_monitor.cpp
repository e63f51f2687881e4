#include <gtest/gtest.h>

#include "node/real_time_monitor.h"

namespace spherical_springs {
namespace {

TEST(RealTimeMonitor, IsThereWhenLessIsSimulatedThanDue) {
  RealTimeMonitor monitor(2, 0.001);
  EXPECT_FALSE(monitor.behind(true, 10, 0));
  EXPECT_FALSE(monitor.behind(true, 11, 1.9));
  EXPECT_TRUE(monitor.behind(true, 12, 3.5));
  EXPECT_TRUE(monitor.behind(true, 12.1, 3.7)) << "too short to judge anew";
  EXPECT_FALSE(monitor.behind(true, 13, 5.5));
}

TEST(RealTimeMonitor, IsNotThereWhilePaused) {
  RealTimeMonitor monitor(1, 0.001);
  monitor.behind(true, 10, 0);
  EXPECT_TRUE(monitor.behind(true, 12, 1));
  EXPECT_FALSE(monitor.behind(false, 14, 1));
  EXPECT_FALSE(monitor.behind(true, 16, 1));
  EXPECT_FALSE(monitor.behind(true, 17, 2));
}

TEST(RealTimeMonitor, IsNotThereWhenTimeOrTheClockGoesBack) {
  RealTimeMonitor monitor(1, 0.001);
  monitor.behind(true, 10, 5);
  EXPECT_FALSE(monitor.behind(true, 12, 0));
  EXPECT_FALSE(monitor.behind(true, 3, 1));
}

TEST(RealTimeMonitor, JudgesAnewWhereSomethingElseIsExpected) {
  RealTimeMonitor monitor(1, 0.001);
  monitor.behind(true, 10, 0);
  EXPECT_TRUE(monitor.behind(true, 12, 1));
  monitor.expect(1, 0.001);
  EXPECT_TRUE(monitor.behind(true, 12.1, 1)) << "it is as before";
  monitor.expect(3, 0.001);
  EXPECT_FALSE(monitor.behind(true, 13, 2));
  EXPECT_FALSE(monitor.behind(true, 14, 5));
  EXPECT_TRUE(monitor.behind(true, 15, 6));
}

TEST(RealTimeMonitor, TakesNoStepThatIsYetToComeForOne) {
  RealTimeMonitor monitor(1, 2);
  monitor.behind(true, 10, 0);
  EXPECT_FALSE(monitor.behind(true, 11.9, 0));
}

}  // namespace
}  // namespace spherical_springs
