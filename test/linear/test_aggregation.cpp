// Groups of rows of a matrix, whatever its couplings are.
#include <gtest/gtest.h>

#include <limits>

#include "linear/aggregation.h"
#include "support/scenes.h"

namespace spherical_springs::core {
namespace {

/// Each row beside the `reach` rows before it and after it.
BlockPattern bandPattern(std::uint32_t rows, std::uint32_t reach) {
  Graph graph;
  graph.first = {0};
  for (std::uint32_t i = 0; i < rows; ++i) {
    for (std::uint32_t j = i > reach ? i - reach : 0; j < rows && j <= i + reach; ++j) {
      graph.neighbours.push_back(j);
    }
    graph.first.push_back(static_cast<std::uint32_t>(graph.neighbours.size()));
  }
  return BlockPattern(std::move(graph), 1);
}

void expectPairs(const Aggregation& aggregation) {
  for (std::size_t a = 0; a < aggregation.size(); ++a) {
    EXPECT_GE(aggregation.first_member[a + 1] - aggregation.first_member[a], 2u);
  }
}

TEST(Aggregation, LeavesOutRowsWhoseCouplingsAreZero) {
  const BlockPattern pattern = bandPattern(40, 2);
  std::vector<float> strength(pattern.graph.neighbours.size(), 0);
  EXPECT_EQ(aggregated(pattern, strength, 8).size(), 0u);
  strength[pattern.place(4, 5)] = strength[pattern.place(5, 4)] = 1;
  const Aggregation pair = aggregated(pattern, strength, 8);
  EXPECT_EQ(pair.members, (std::vector<std::uint32_t>{4, 5}));
  EXPECT_EQ(coarseGraph(pattern, pair, 1).neighbours, std::vector<std::uint32_t>{0});
}

// Not a number, too, and no symmetry.
TEST(Aggregation, HasTwoRowsOrMoreInEachGroup) {
  const float couplings[] = {0, 1e-45f, 1, std::numeric_limits<float>::infinity(),
                             std::numeric_limits<float>::quiet_NaN()};
  for (unsigned seed = 1; seed <= 100; ++seed) {
    testing::Random random(seed);
    const BlockPattern pattern = bandPattern(100, 1 + seed % 4);
    std::vector<float> strength(pattern.graph.neighbours.size());
    for (float& coupling : strength) coupling = couplings[random.below(5)];
    expectPairs(aggregated(pattern, strength, 8));
  }
}

}  // namespace
}  // namespace spherical_springs::core
