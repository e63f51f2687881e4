// How long the search for a map goes on.
#include <gtest/gtest.h>

#include <thread>

#include "maps/map_clock.h"

namespace spherical_springs::mesh {
namespace {

MapOptions endless() {
  MapOptions options;
  options.max_time = 1e6;
  return options;
}

TEST(MapClock, GoesOnWithinTheTime) {
  const MapOptions options = endless();
  MapClock clock(options);
  clock.haveMap();
  EXPECT_TRUE(clock.goOn());
  EXPECT_NO_THROW(clock.check());
  EXPECT_FALSE(clock.ended());
}

TEST(MapClock, EndsAfterTheTimeIfThereIsAMap) {
  MapOptions options;
  options.max_time = 0;
  double fraction = 0;
  options.go_on = [&](double f) { return fraction = f, true; };
  MapClock clock(options);
  EXPECT_FALSE(clock.goOn());
  EXPECT_EQ(fraction, 1);
  EXPECT_NO_THROW(clock.check());
  EXPECT_FALSE(clock.ended());
  clock.haveMap();
  EXPECT_THROW(clock.check(), TimeIsOver);
  EXPECT_TRUE(clock.ended());
}

TEST(MapClock, EndsWhenItIsToldOnce) {
  MapOptions options = endless();
  int calls = 0;
  options.go_on = [&](double) { return ++calls != 2; };
  MapClock clock(options);
  clock.haveMap();
  EXPECT_TRUE(clock.goOn());
  EXPECT_FALSE(clock.goOn());
  EXPECT_FALSE(clock.goOn());
  EXPECT_THROW(clock.check(), TimeIsOver);
}

TEST(MapClock, EndsWithoutMemory) {
  const MapOptions options = endless();
  MapClock clock(options);
  clock.haveMap();
  EXPECT_FALSE(clock.outOfMemory());
  clock.endWithoutMemory();
  EXPECT_TRUE(clock.outOfMemory());
  EXPECT_FALSE(clock.goOn());
  EXPECT_THROW(clock.check(), TimeIsOver);
}

TEST(MapClock, CallsAgainWhileThereIsNoMap) {
  MapOptions options;
  options.max_time = 0;
  int calls = 0;
  options.go_on = [&](double) -> bool {
    if (++calls == 3) throw std::domain_error("enough");
    return true;
  };
  MapClock clock(options);
  EXPECT_THROW(for (;;) clock.check(), std::domain_error);
}

TEST(MapClock, CallsOnItsOwnThreadOnly) {
  MapOptions options;
  options.max_time = 0;
  int calls = 0;
  options.go_on = [&](double) { return ++calls > 0; };
  MapClock clock(options);
  clock.haveMap();
  std::thread([&] { EXPECT_THROW(clock.check(), TimeIsOver); }).join();
  EXPECT_EQ(calls, 0);
}

}  // namespace
}  // namespace spherical_springs::mesh
