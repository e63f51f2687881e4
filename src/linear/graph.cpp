#include "linear/graph.h"

#include <algorithm>
#include <numeric>

namespace spherical_springs::core {
namespace {

/// The blocks whose nodes some node of block `b` has for neighbours, once each.
std::vector<std::vector<std::uint32_t>> touchedBlocks(const Graph& graph, std::size_t block_size,
                                                      std::size_t count, int threads) {
  std::vector<std::vector<std::uint32_t>> touched(count);
  forOnThreads(count, worthwhileThreads(graph.size(), threads), [&](std::ptrdiff_t b) {
    const std::size_t end = std::min(graph.size(), (b + 1) * block_size);
    auto& mine = touched[b];
    for (std::uint32_t e = graph.first[b * block_size]; e < graph.first[end]; ++e) {
      const auto other = static_cast<std::uint32_t>(graph.neighbours[e] / block_size);
      if (mine.empty() || mine.back() != other) mine.push_back(other);
    }
    std::sort(mine.begin(), mine.end());
    mine.erase(std::unique(mine.begin(), mine.end()), mine.end());
  });
  return touched;
}

using Touched = std::vector<std::vector<std::uint32_t>>;

/// For each block, greedily, the first colour that none of its neighbours has yet. `forEachNear`
/// calls a function for all neighbours of a block.
template <class ForEachNear>
std::vector<std::uint32_t> coloursOf(std::size_t count, const ForEachNear& forEachNear) {
  constexpr std::uint32_t kNone = ~0u;
  std::vector<std::uint32_t> colours(count, kNone);
  std::vector<std::uint32_t> taken_by;  // the last block that found a colour taken
  for (std::uint32_t b = 0; b < count; ++b) {
    forEachNear(b, [&](std::uint32_t other) {
      if (colours[other] != kNone) taken_by[colours[other]] = b;
    });
    std::uint32_t colour = 0;
    while (colour < taken_by.size() && taken_by[colour] == b) ++colour;
    if (colour == taken_by.size()) taken_by.push_back(kNone);
    colours[b] = colour;
  }
  return colours;
}

Schedule scheduleOf(const std::vector<std::uint32_t>& colours) {
  Schedule schedule;
  schedule.blocks.resize(colours.size());
  std::iota(schedule.blocks.begin(), schedule.blocks.end(), 0);
  std::stable_sort(schedule.blocks.begin(), schedule.blocks.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return colours[a] < colours[b]; });
  for (std::uint32_t b = 0; b < colours.size(); ++b) {
    if (b == 0 || colours[schedule.blocks[b]] != colours[schedule.blocks[b - 1]]) {
      schedule.first.push_back(b);
    }
  }
  schedule.first.push_back(static_cast<std::uint32_t>(colours.size()));
  return schedule;
}

}  // namespace

std::vector<std::uint32_t> componentsOf(const Graph& graph) {
  constexpr std::uint32_t kNone = ~0u;
  std::vector<std::uint32_t> component(graph.size(), kNone);
  std::vector<std::uint32_t> reached;
  std::uint32_t count = 0;
  for (std::uint32_t start = 0; start < graph.size(); ++start) {
    if (component[start] != kNone) continue;
    component[start] = count;
    reached = {start};
    for (std::size_t n = 0; n < reached.size(); ++n) {
      const std::uint32_t i = reached[n];
      for (std::uint32_t e = graph.first[i]; e < graph.first[i + 1]; ++e) {
        const std::uint32_t j = graph.neighbours[e];
        if (component[j] != kNone) continue;
        component[j] = count;
        reached.push_back(j);
      }
    }
    ++count;
  }
  return component;
}

BlockOrder blockOrder(const Graph& graph, std::size_t block_size, int threads) {
  const std::size_t nodes = graph.size();
  const std::size_t count = (nodes + block_size - 1) / block_size;
  const Touched touched = touchedBlocks(graph, block_size, count, threads);

  BlockOrder order;
  order.block_size = block_size;
  order.apart = scheduleOf(coloursOf(count, [&](std::uint32_t block, const auto& visit) {
    for (const std::uint32_t near : touched[block]) visit(near);
  }));

  for (std::size_t block = 0; block <= count; ++block) {
    order.first_node.push_back(static_cast<std::uint32_t>(std::min(nodes, block * block_size)));
  }
  order.rank.resize(nodes);
  std::uint32_t next = 0;
  for (const std::uint32_t block : order.apart.blocks) {
    for (std::uint32_t i = order.first_node[block]; i < order.first_node[block + 1]; ++i) {
      order.rank[i] = next++;
    }
  }
  return order;
}

Schedule farApart(const Graph& graph, const BlockOrder& order, int threads) {
  const Touched touched = touchedBlocks(graph, order.block_size, order.blocks(), threads);
  return scheduleOf(coloursOf(order.blocks(), [&](std::uint32_t block, const auto& visit) {
    for (const std::uint32_t near : touched[block]) {
      for (const std::uint32_t other : touched[near]) visit(other);
    }
  }));
}

}  // namespace spherical_springs::core
