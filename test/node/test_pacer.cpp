#include <gtest/gtest.h>

#include "node/pacer.h"

namespace spherical_springs {
namespace {

TEST(Pacer, CountsStepsByTheClock) {
  Pacer pacer(0.001, 1);
  EXPECT_EQ(pacer.due(0.0104), 10u);
  EXPECT_EQ(pacer.due(0.0107), 11u);  // what was left of a step counts
  EXPECT_EQ(pacer.due(0), 0u);
}

TEST(Pacer, FollowsTheRealTimeFactor) { EXPECT_EQ(Pacer(0.5, 10).due(0.25), 5u); }

TEST(Pacer, WaitsForAStepLongerThanATick) {
  Pacer pacer(0.04, 1);
  EXPECT_EQ(pacer.due(0.03), 0u);
  EXPECT_EQ(pacer.due(0.03), 1u);
}

TEST(Pacer, NeitherGoesBackNorPilesUp) {
  Pacer pacer(0.5, 1);
  EXPECT_EQ(pacer.due(-100), 0u);
  EXPECT_EQ(pacer.due(100), 2u);
  EXPECT_EQ(pacer.due(0.1), 0u);
  EXPECT_LE(Pacer(1e-12, 1e6).due(1), 1000000000000000u);
}

}  // namespace
}  // namespace spherical_springs
