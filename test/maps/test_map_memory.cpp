// Memory that runs out while a map is sought loses no map that is there.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "maps/coverage.h"
#include "maps/map_energy.h"
#include "spherical_springs/maps/sphere_map.h"
#include "support/failing_malloc.h"
#include "support/shapes.h"

namespace spherical_springs::mesh {
namespace {

class MapShortOfMemory : public core::testing::ShortOfMemory {
 protected:
  MapShortOfMemory() : mesh_(testing::bumps(2, 3)) {
    testing::Random random(5);
    shares_ = testing::sharesOf(mesh_);
    for (Eigen::Index f = 0; f < shares_.size(); ++f) {
      shares_[f] *= std::exp(random.between(-2, 2));
    }
    shares_ *= 4 * core::kPi / shares_.sum();
    options_.tolerance = 0.03;  // which takes hops
    options_.max_time = 1e6;
    options_.threads = 2;
    options_.out_of_memory = [this] { ++times_said_; };
  }

  double spread(const Points& map) { return MapEnergy(mesh_.faces, shares_, map, 1).spread(); }

  void expectCoversOnce(const Points& map, const std::string& where) {
    ASSERT_EQ(map.cols(), mesh_.vertices.cols()) << where;
    EXPECT_LT((map.colwise().norm().array() - 1).abs().maxCoeff(), 1e-14) << where;
    EXPECT_TRUE(coversOnce(mesh_.faces, map)) << where;
  }

  /// Lets allocations of `find()`, a search for a map, fail at growing distances up to its last.
  template <class Find>
  void expectNoMapIsLost(bool for_good, const Find& find) {
    Points undisturbed, map;
    const long allocations = allocationsOf([&] { undisturbed = find(); });
    double first = 0, last = 0;  // spread of maps so far
    int without = 0, so_far = 0;
    for (long number = 0; number < allocations; number += 1 + number / 16) {
      const std::string where = "at allocation " + std::to_string(number);
      times_said_ = 0;
      if (fails(number, for_good, [&] { map = find(); })) {
        EXPECT_EQ(so_far, 0) << "a map was lost " << where;
        EXPECT_EQ(times_said_, 0) << where;
        ++without;
      } else if (times_said_ == 0) {  // nothing that needs memory
        EXPECT_EQ(map, undisturbed) << where;
      } else {
        EXPECT_EQ(times_said_, 1) << where;
        expectCoversOnce(map, where);
        last = spread(map);
        if (++so_far == 1) first = last;
      }
    }
    EXPECT_GT(without, 10);
    EXPECT_GT(so_far, 10);
    EXPECT_LT(last, 0.5 * first);
    EXPECT_EQ(find(), undisturbed);
  }

  TriangleMesh mesh_;
  Eigen::VectorXd shares_;
  MapOptions options_;
  int times_said_ = 0;
};

TEST_F(MapShortOfMemory, GivesTheBestSoFar) {
  for (const bool for_good : {false, true}) {
    expectNoMapIsLost(for_good, [&] { return sphereMap(mesh_, shares_, options_); });
  }
}

TEST_F(MapShortOfMemory, GivesTheBestSoFarFromAStart) {
  const Points start = mesh_.vertices;
  for (const bool for_good : {false, true}) {
    expectNoMapIsLost(for_good, [&] { return sphereMap(mesh_, shares_, start, options_); });
  }
}

// Each vertex alone may have come to where faces cover a part twice.
TEST_F(MapShortOfMemory, SweepsAllOrNothing) {
  const Points start = mesh_.vertices.colwise().normalized();
  MapEnergy energy(mesh_.faces, shares_, start, 1);
  const int failures = failAgainAndAgain(
      true, [&] { energy.sweep(); },
      [&](const std::string& where) { EXPECT_EQ(energy.points(), start) << where; });
  EXPECT_GT(failures, 1);
  EXPECT_NE(energy.points(), start);
}

}  // namespace
}  // namespace spherical_springs::mesh
