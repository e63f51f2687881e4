// Which rows of a sparse matrix meet, and an order of them in which threads can share the work.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/parallel.h"

namespace spherical_springs::core {

/// Neighbours of each node, itself among them.
struct Graph {
  std::vector<std::uint32_t> first;  ///< where the neighbours of each node begin, and the end
  std::vector<std::uint32_t> neighbours;

  std::size_t size() const { return first.size() - 1; }
};

/// Blocks of nodes, in colours: threads may work on all blocks of one colour at once.
struct Schedule {
  std::vector<std::uint32_t> blocks;  ///< colour by colour
  std::vector<std::uint32_t> first;   ///< among them of each colour, and the end

  /// Calls `body(block)` for all blocks, one colour after another.
  template <class Body>
  void forEach(int threads, const Body& body) const {
    const std::ptrdiff_t colours = static_cast<std::ptrdiff_t>(first.size()) - 1;
    for (std::ptrdiff_t c = 0; c < colours; ++c) {
      forOnThreads(first[c + 1] - first[c], threads,
                   [&](std::ptrdiff_t b) { body(blocks[first[c] + b]); });
    }
  }

  /// Calls `body(block)` for all blocks, from the last colour to the first.
  template <class Body>
  void forEachBackward(int threads, const Body& body) const {
    const std::ptrdiff_t colours = static_cast<std::ptrdiff_t>(first.size()) - 1;
    for (std::ptrdiff_t c = colours - 1; c >= 0; --c) {
      forOnThreads(first[c + 1] - first[c], threads,
                   [&](std::ptrdiff_t b) { body(blocks[first[c] + b]); });
    }
  }
};

/// Blocks of neighbouring nodes, and how threads may share them without results that depend on how
/// many threads there are.
struct BlockOrder {
  std::size_t block_size;                 ///< nodes of each block but the last
  std::vector<std::uint32_t> first_node;  ///< of each block, and the end
  /// Blocks of one colour have no neighbours in each other: each may read neighbours and write to
  /// its own nodes.
  Schedule apart;
  std::vector<std::uint32_t> rank;  ///< of each node in the order of `apart`

  std::size_t blocks() const { return first_node.size() - 1; }
};

/// The number of each node's connected component, from 0.
std::vector<std::uint32_t> componentsOf(const Graph& graph);

/// Blocks of `block_size` nodes whose order is already local. The blocks of each colour rise, so
/// that a thread that takes its share of them in turn, or of all nodes, has about the same ones.
BlockOrder blockOrder(const Graph& graph, std::size_t block_size, int threads);

/// Colours the same blocks so that those of one colour have no common neighbours, either: each may
/// write to its neighbours. Takes the square of the number of blocks where all have one in common.
Schedule farApart(const Graph& graph, const BlockOrder& order, int threads);

}  // namespace spherical_springs::core
