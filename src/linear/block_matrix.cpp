#include "linear/block_matrix.h"

#include <utility>

namespace spherical_springs::core {

BlockPattern::BlockPattern(Graph local_graph, int threads) : graph(std::move(local_graph)) {
  constexpr std::size_t kBlockSize = 128;  // enough to share, small enough for the nearest cache
  order = blockOrder(graph, kBlockSize, threads);
  diagonal.resize(rows());
  parallelFor(rows(), threads, [&](std::ptrdiff_t i) {
    std::sort(graph.neighbours.begin() + graph.first[i],
              graph.neighbours.begin() + graph.first[i + 1],
              [&](std::uint32_t a, std::uint32_t b) { return order.rank[a] < order.rank[b]; });
    diagonal[i] = place(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(i));
  });
}

}  // namespace spherical_springs::core
