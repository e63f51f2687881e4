// How long the search for a map goes on.
#include <gtest/gtest.h>

#include <limits>
#include <thread>
#include <vector>

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
  clock.haveMap(0.5);
  EXPECT_TRUE(clock.goOn());
  EXPECT_NO_THROW(clock.check());
  EXPECT_FALSE(clock.ended());
}

TEST(MapClock, EndsAfterTheTimeIfThereIsAMap) {
  MapOptions options;
  options.max_time = 0;
  double fraction = 0;
  options.go_on = [&](const MapProgress& p) { return fraction = p.fraction, true; };
  MapClock clock(options);
  EXPECT_FALSE(clock.goOn());
  EXPECT_EQ(fraction, 1);
  EXPECT_NO_THROW(clock.check());
  EXPECT_FALSE(clock.ended());
  clock.haveMap(0.5);
  EXPECT_THROW(clock.check(), TimeIsOver);
  EXPECT_TRUE(clock.ended());
}

TEST(MapClock, EndsWhenItIsToldOnce) {
  MapOptions options = endless();
  int calls = 0;
  options.go_on = [&](const MapProgress&) { return ++calls != 2; };
  MapClock clock(options);
  clock.haveMap(0.5);
  EXPECT_TRUE(clock.goOn());
  EXPECT_FALSE(clock.goOn());
  EXPECT_FALSE(clock.goOn());
  EXPECT_THROW(clock.check(), TimeIsOver);
}

TEST(MapClock, EndsWithoutMemory) {
  const MapOptions options = endless();
  MapClock clock(options);
  clock.haveMap(0.5);
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
  options.go_on = [&](const MapProgress&) -> bool {
    if (++calls == 3) throw std::domain_error("enough");
    return true;
  };
  MapClock clock(options);
  EXPECT_THROW(for (;;) clock.check(), std::domain_error);
}

TEST(MapClock, TellsOfTheBestMapSoFar) {
  MapOptions options = endless();
  std::vector<double> told;
  options.go_on = [&](const MapProgress& progress) {
    return told.push_back(progress.spread), true;
  };
  MapClock clock(options);
  clock.goOn();
  EXPECT_FALSE(clock.hasMap());
  for (const double spread : {0.3, 0.1}) {
    clock.haveMap(spread);
    EXPECT_TRUE(clock.hasMap());
    clock.goOn();
  }
  clock.haveMap(std::numeric_limits<double>::infinity());  // it is a map all the same
  EXPECT_TRUE(clock.hasMap());
  EXPECT_EQ(told, (std::vector<double>{std::numeric_limits<double>::infinity(), 0.3, 0.1}));
}

TEST(MapClock, CallsOnItsOwnThreadOnly) {
  MapOptions options;
  options.max_time = 0;
  int calls = 0;
  options.go_on = [&](const MapProgress&) { return ++calls > 0; };
  MapClock clock(options);
  clock.haveMap(0.5);
  std::thread([&] { EXPECT_THROW(clock.check(), TimeIsOver); }).join();
  EXPECT_EQ(calls, 0);
}

}  // namespace
}  // namespace spherical_springs::mesh
