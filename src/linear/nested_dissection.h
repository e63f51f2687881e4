// An order of elimination that keeps the factor of a sparse matrix small.
#pragma once

#include <cstdint>
#include <vector>

#include "base/checkpoint.h"
#include "linear/graph.h"

namespace spherical_springs::core {

/// A. George, SIAM J. Numer. Anal. 10 (1973): the graph is cut in two by a separator, whose nodes
/// are eliminated after both parts, and so are the parts.
struct NestedDissection {
  /// A separator, or what is too small to be cut.
  struct Part {
    std::uint32_t first, end;             ///< among `order`
    std::vector<std::uint32_t> boundary;  ///< places after `end` that this part and those below it
                                          ///< are joined with, rising
    std::vector<std::uint32_t> children;  ///< parts that it has separated
  };
  std::vector<std::uint32_t> order;   ///< nodes as they are eliminated
  std::vector<std::uint32_t> places;  ///< of each node among `order`
  std::vector<Part> parts;            ///< children before parents; a root is no one's child
};

/// Nodes with far more neighbours than most come last.
NestedDissection nestedDissection(const Graph& graph, const Checkpoint& checkpoint = passAll);

}  // namespace spherical_springs::core
