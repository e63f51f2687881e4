// An order of elimination for graphs that no short cut parts.
#pragma once

#include <cstdint>
#include <vector>

#include "base/checkpoint.h"
#include "linear/graph.h"

namespace spherical_springs::core {

/// Nodes that are eliminated together, and the groups before that one to which theirs leads.
struct EliminationGroup {
  std::vector<std::uint32_t> nodes;
  std::vector<std::uint32_t> children;  ///< indices of groups
};

/// Groups the nodes by an order in which each next node is one of about the fewest neighbours in
/// what elimination has left (P. Amestoy, T. Davis and I. Duff, SIAM J. Matrix Anal. Appl. 17,
/// 1996). Groups stand in postorder. The last one, of nodes with very many neighbours, is the root,
/// and may be empty.
std::vector<EliminationGroup> minimumDegree(const Graph& graph,
                                            const Checkpoint& checkpoint = passAll);

}  // namespace spherical_springs::core
