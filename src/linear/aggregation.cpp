#include "linear/aggregation.h"

#include <algorithm>

namespace spherical_springs::core {
namespace {

constexpr std::uint32_t kNone = Aggregation::kNone;

/// Calls `visit(neighbour, strength)` for the strong couplings of a row.
template <class Visitor>
void forEachStrong(const BlockPattern& pattern, const std::vector<float>& strength,
                   std::uint32_t row, const Visitor& visit) {
  constexpr float kWeak = 0.1f;  // of the row's strongest
  const Graph& graph = pattern.graph;
  float strongest = 0;
  for (std::uint32_t e = graph.first[row]; e < graph.first[row + 1]; ++e) {
    if (e != pattern.diagonal[row]) strongest = std::max(strongest, strength[e]);
  }
  if (strongest == 0) return;
  for (std::uint32_t e = graph.first[row]; e < graph.first[row + 1]; ++e) {
    if (e != pattern.diagonal[row] && strength[e] >= kWeak * strongest) {
      visit(graph.neighbours[e], strength[e]);
    }
  }
}

/// Rows around `root` that have no group yet, nearest first, up to `size` of them.
void growGroup(const BlockPattern& pattern, const std::vector<float>& strength, std::size_t size,
               std::uint32_t name, std::vector<std::uint32_t>& group,
               std::vector<std::uint32_t>& aggregate) {
  for (std::size_t next = 0; next < group.size() && group.size() < size; ++next) {
    forEachStrong(pattern, strength, group[next], [&](std::uint32_t neighbour, float) {
      if (group.size() >= size || aggregate[neighbour] != kNone) return;
      aggregate[neighbour] = name;
      group.push_back(neighbour);
    });
  }
}

/// The group that the rows of `group` are most strongly joined with, or their own.
std::uint32_t strongestNeighbour(const BlockPattern& pattern, const std::vector<float>& strength,
                                 const std::vector<std::uint32_t>& group,
                                 const std::vector<std::uint32_t>& aggregate) {
  std::uint32_t best = aggregate[group.front()];
  const std::uint32_t own = best;
  float strongest = 0;
  for (const std::uint32_t row : group) {
    forEachStrong(pattern, strength, row, [&](std::uint32_t neighbour, float coupling) {
      const std::uint32_t other = aggregate[neighbour];
      if (other == own || other == kNone || coupling <= strongest) return;
      strongest = coupling;
      best = other;
    });
  }
  return best;
}

void listMembers(std::size_t count, Aggregation& aggregation) {
  aggregation.first_member.assign(count + 1, 0);
  for (const std::uint32_t a : aggregation.aggregate) {
    if (a != kNone) ++aggregation.first_member[a + 1];
  }
  for (std::size_t a = 0; a < count; ++a) {
    aggregation.first_member[a + 1] += aggregation.first_member[a];
  }
  auto next = aggregation.first_member;
  aggregation.members.resize(next.back());
  for (std::uint32_t i = 0; i < aggregation.aggregate.size(); ++i) {
    if (aggregation.aggregate[i] == kNone) continue;
    aggregation.members[next[aggregation.aggregate[i]]++] = i;
  }
}

}  // namespace

Aggregation aggregated(const BlockPattern& pattern, const std::vector<float>& strength,
                       std::size_t size) {
  Aggregation result;
  result.aggregate.assign(pattern.rows(), kNone);
  std::uint32_t count = 0;
  std::vector<std::uint32_t> group;
  for (std::uint32_t root = 0; root < pattern.rows(); ++root) {
    if (result.aggregate[root] != kNone) continue;
    result.aggregate[root] = count;
    group = {root};
    growGroup(pattern, strength, size, count, group, result.aggregate);
    std::uint32_t joined = count;
    if (group.size() < size / 2) {  // what other groups have left over
      joined = strongestNeighbour(pattern, strength, group, result.aggregate);
    }
    if (joined == count && group.size() == 1) joined = kNone;
    for (const std::uint32_t row : group) result.aggregate[row] = joined;
    count += joined == count;
  }
  listMembers(count, result);
  return result;
}

Graph coarseGraph(const BlockPattern& fine, const Aggregation& aggregation, int threads) {
  const std::size_t count = aggregation.size();
  std::vector<std::vector<std::uint32_t>> rows(count);
  parallelFor(count, threads, [&](std::ptrdiff_t a) {
    auto& row = rows[a];
    for (std::uint32_t m = aggregation.first_member[a]; m < aggregation.first_member[a + 1]; ++m) {
      const std::uint32_t i = aggregation.members[m];
      for (std::uint32_t e = fine.graph.first[i]; e < fine.graph.first[i + 1]; ++e) {
        const std::uint32_t other = aggregation.aggregate[fine.graph.neighbours[e]];
        if (other != kNone) row.push_back(other);
      }
    }
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
  });
  Graph graph;
  graph.first = {0};
  for (const auto& row : rows) {
    graph.neighbours.insert(graph.neighbours.end(), row.begin(), row.end());
    graph.first.push_back(static_cast<std::uint32_t>(graph.neighbours.size()));
  }
  return graph;
}

}  // namespace spherical_springs::core
