#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <numeric>
#include <set>

#include "geometry/curve_order.h"
#include "linear/block_matrix.h"
#include "support/relaxation_scenes.h"

namespace spherical_springs::core {
namespace {

/// Graph of pairs of nodes, and of each node with itself.
Graph graphOf(std::size_t nodes, const std::vector<std::array<std::uint32_t, 2>>& pairs) {
  std::vector<std::set<std::uint32_t>> neighbours(nodes);
  for (std::uint32_t i = 0; i < nodes; ++i) neighbours[i].insert(i);
  for (const auto& [a, b] : pairs) {
    neighbours[a].insert(b);
    neighbours[b].insert(a);
  }
  Graph graph;
  graph.first = {0};
  for (const auto& row : neighbours) {
    graph.neighbours.insert(graph.neighbours.end(), row.begin(), row.end());
    graph.first.push_back(static_cast<std::uint32_t>(graph.neighbours.size()));
  }
  return graph;
}

Graph icosphereGraph(int level) {
  const auto mesh = benchmark_scenes::icosphere(level);
  Points points(3, mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) points.col(i) = mesh.vertices[i];
  const auto order = curveOrder(points);
  std::vector<std::uint32_t> number(order.size());
  for (std::uint32_t n = 0; n < order.size(); ++n) number[order[n]] = n;
  auto edges = mesh.edges;
  for (auto& [a, b] : edges) a = number[a], b = number[b];
  return graphOf(order.size(), edges);
}

/// `edges` pairs, some of them far from each other in number.
Graph randomGraph(std::uint32_t nodes, std::uint32_t edges) {
  testing::Random random(1);
  std::vector<std::array<std::uint32_t, 2>> pairs;
  for (std::uint32_t i = 0; i < edges; ++i) {
    pairs.push_back({random.below(nodes), random.below(nodes)});
  }
  return graphOf(nodes, pairs);
}

std::vector<Graph> graphs() {
  return {icosphereGraph(5),      icosphereGraph(2),      randomGraph(5000, 3000),
          randomGraph(4500, 600), randomGraph(700, 6000), graphOf(300, {}),
          graphOf(1, {}),         graphOf(0, {})};
}

/// The colour of each block, which must be in the schedule once.
std::vector<std::size_t> coloursOf(const Schedule& schedule, std::size_t blocks) {
  std::vector<std::uint32_t> sorted = schedule.blocks;
  std::sort(sorted.begin(), sorted.end());
  std::vector<std::uint32_t> all(blocks);
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(sorted, all);
  std::vector<std::size_t> colours(blocks);
  for (std::size_t c = 0; c + 1 < schedule.first.size(); ++c) {
    for (std::uint32_t b = schedule.first[c]; b < schedule.first[c + 1]; ++b) {
      colours[schedule.blocks[b]] = c;
      EXPECT_TRUE(b == schedule.first[c] || schedule.blocks[b] > schedule.blocks[b - 1]);
    }
  }
  return colours;
}

constexpr std::size_t kBlockSize = 32;

TEST(BlockOrder, BlocksOfOneColourDoNotMeet) {
  for (const Graph& graph : graphs()) {
    SCOPED_TRACE(graph.neighbours.size());
    const BlockOrder order = blockOrder(graph, kBlockSize, 1);
    const auto apart = coloursOf(order.apart, order.blocks());
    const auto far_apart = coloursOf(farApart(graph, order, 1), order.blocks());
    std::size_t meetings = 0, far_meetings = 0;
    for (std::uint32_t i = 0; i < graph.size(); ++i) {
      const std::size_t block = i / kBlockSize;
      std::set<std::size_t> near, colours;
      for (std::uint32_t e = graph.first[i]; e < graph.first[i + 1]; ++e) {
        const std::size_t other = graph.neighbours[e] / kBlockSize;
        near.insert(other);
        colours.insert(far_apart[other]);
        meetings += other != block && apart[other] == apart[block];
      }
      // All blocks that write to this node.
      far_meetings += colours.size() != near.size();
    }
    EXPECT_EQ(meetings, 0);
    EXPECT_EQ(far_meetings, 0);
  }
}

TEST(BlockOrder, HasEveryNodeOnce) {
  for (const Graph& graph : graphs()) {
    const BlockOrder order = blockOrder(graph, kBlockSize, 1);
    ASSERT_EQ(order.blocks(), (graph.size() + kBlockSize - 1) / kBlockSize);
    EXPECT_EQ(order.first_node.front(), 0);
    EXPECT_EQ(order.first_node.back(), graph.size());
    std::uint32_t next = 0;  // in the order of a sweep
    for (const std::uint32_t block : order.apart.blocks) {
      EXPECT_GT(order.first_node[block + 1], order.first_node[block]);
      for (std::uint32_t i = order.first_node[block]; i < order.first_node[block + 1]; ++i) {
        EXPECT_EQ(order.rank[i], next++);
      }
    }
    EXPECT_EQ(next, graph.size());
  }
}

TEST(BlockOrder, DoesNotDependOnThreads) {
  const Graph graph = icosphereGraph(5);
  const BlockOrder expected = blockOrder(graph, kBlockSize, 1);
  const Schedule expected_far = farApart(graph, expected, 1);
  for (const int threads : {2, 3}) {
    const BlockOrder order = blockOrder(graph, kBlockSize, threads);
    EXPECT_EQ(order.apart.blocks, expected.apart.blocks);
    const Schedule far = farApart(graph, order, threads);
    EXPECT_EQ(far.blocks, expected_far.blocks);
    EXPECT_EQ(far.first, expected_far.first);
    EXPECT_EQ(order.rank, expected.rank);
  }
}

TEST(Schedule, IsDoneOneColourAfterAnother) {
  const Schedule schedule = blockOrder(icosphereGraph(5), kBlockSize, 1).apart;
  const std::size_t count = schedule.blocks.size();
  const auto colours = coloursOf(schedule, count);
  for (const int threads : {1, 2, 3}) {
    std::vector<int> visits(count, 0);
    std::atomic<std::size_t> finished{0}, early{0};
    // At a block, all of the colours before it are over.
    const auto body = [&](std::size_t before, std::uint32_t block) {
      early += finished < before;
      ++visits[block];
      ++finished;
    };
    schedule.forEach(threads,
                     [&](std::uint32_t block) { body(schedule.first[colours[block]], block); });
    EXPECT_EQ(finished, count);
    finished = 0;
    schedule.forEachBackward(threads, [&](std::uint32_t block) {
      body(count - schedule.first[colours[block] + 1], block);
    });
    EXPECT_EQ(early, 0);
    EXPECT_EQ(visits, std::vector<int>(count, 2));
  }
}

TEST(BlockPattern, FindsEveryBlock) {
  for (const Graph& graph : graphs()) {
    const BlockPattern pattern(graph, 2);
    const auto& rank = pattern.order.rank;
    for (std::uint32_t i = 0; i < graph.size(); ++i) {
      EXPECT_EQ(pattern.graph.neighbours[pattern.diagonal[i]], i);
      for (std::uint32_t e = graph.first[i]; e < graph.first[i + 1]; ++e) {
        const std::uint32_t j = graph.neighbours[e];
        const std::uint32_t place = pattern.place(i, j);
        ASSERT_TRUE(place >= graph.first[i] && place < graph.first[i + 1]);
        EXPECT_EQ(pattern.graph.neighbours[place], j);
        EXPECT_EQ(place < pattern.diagonal[i], rank[j] < rank[i]);
      }
    }
  }
}

}  // namespace
}  // namespace spherical_springs::core
