// Groups of strongly joined rows, the coarse unknowns of a multigrid.
#pragma once

#include <cstdint>
#include <vector>

#include "linear/block_matrix.h"

namespace spherical_springs::core {

struct Aggregation {
  static constexpr std::uint32_t kNone = ~0u;
  std::vector<std::uint32_t> aggregate;     ///< of each row; kNone where nothing couples it
  std::vector<std::uint32_t> first_member;  ///< of each aggregate, and the end
  std::vector<std::uint32_t> members;       ///< rows, rising within an aggregate

  std::size_t size() const { return first_member.size() - 1; }
};

/// Greedy groups of about `size` coupled rows, numbered so that neighbours are close. `strength`:
/// of the coupling at each place of the pattern; weak ones are not followed, and a row that has
/// none above 0 is in no group. Each group has two rows or more, so that a hierarchy of them ends.
Aggregation aggregated(const BlockPattern& pattern, const std::vector<float>& strength,
                       std::size_t size);

/// The graph of the aggregates: neighbours where any of their rows are.
Graph coarseGraph(const BlockPattern& fine, const Aggregation& aggregation, int threads);

}  // namespace spherical_springs::core
