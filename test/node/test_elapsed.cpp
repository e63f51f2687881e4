#include <gtest/gtest.h>

#include "node/elapsed.h"

namespace spherical_springs {
namespace {

TEST(Elapsed, IsExactToTheNanosecond) {
  const ros::Time begin(1'700'000'000, 999'999'999), end(1'700'000'001, 1);
  EXPECT_DOUBLE_EQ(secondsBetween(begin, end), 2e-9);
  EXPECT_DOUBLE_EQ(secondsBetween(end, begin), -2e-9);
  EXPECT_EQ(secondsBetween(end, end), 0);
}

TEST(Elapsed, HoldsAnyTwoTimes) {
  const ros::Time first(0, 0), last(4'294'967'295, 999'999'999);
  EXPECT_NEAR(secondsBetween(first, last), 4294967296., 1e-6);
  EXPECT_NEAR(secondsBetween(last, first), -4294967296., 1e-6);
}

}  // namespace
}  // namespace spherical_springs
