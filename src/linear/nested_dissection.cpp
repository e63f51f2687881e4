#include "linear/nested_dissection.h"

#include <algorithm>
#include <cmath>

#include "linear/minimum_degree.h"

namespace spherical_springs::core {
namespace {

using Nodes = std::vector<std::uint32_t>;

constexpr std::size_t kTooSmall = 24;  // to be cut
constexpr std::uint32_t kNowhere = ~0u;

class Dissection {
 public:
  Dissection(const Graph& graph, const Checkpoint& checkpoint)
      : graph_(graph),
        checkpoint_(checkpoint),
        region_(graph.size(), 0),
        level_(graph.size(), kNowhere) {
    result_.places.assign(graph.size(), kNowhere);
  }

  NestedDissection run() {
    Nodes all(graph_.size());
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    dissect(std::move(all));
    findBoundaries();
    return std::move(result_);
  }

 private:
  struct Halves {
    Nodes before, separator, after;
  };

  /// @return the parts at the top of what the nodes have become.
  Nodes dissect(Nodes nodes) {
    checkpoint_();
    if (nodes.size() <= kTooSmall) return {eliminate(nodes, {})};
    const std::uint32_t region = ++regions_;
    for (const std::uint32_t i : nodes) region_[i] = region;
    Nodes reached = levels(nodes.front(), region);
    if (reached.size() < nodes.size()) return dissectPieces(nodes, region);
    // From one end of the graph, so that levels are short.
    reached = levels(reached.back(), region);
    Halves halves = cut(reached, region);
    for (const std::uint32_t i : nodes) level_[i] = kNowhere;
    if (isWide(halves.separator, nodes)) return dissectByDegree(std::move(nodes), region);
    nodes.clear();
    Nodes children = dissect(std::move(halves.before));
    append(dissect(std::move(halves.after)), children);
    return {eliminate(halves.separator, children)};
  }

  /// Whether a cut is far longer than the root of the number of nodes, with which most meshes can
  /// do; that is so where a node has most others for neighbours.
  static bool isWide(const Nodes& separator, const Nodes& nodes) {
    constexpr double kWide = 4;
    return separator.empty() ||
           separator.size() > kWide * std::sqrt(static_cast<double>(nodes.size()));
  }

  Nodes dissectByDegree(Nodes nodes, std::uint32_t region) {
    std::sort(nodes.begin(), nodes.end());
    const auto groups = minimumDegree(partOfGraph(nodes, region), checkpoint_);
    Nodes parts;
    for (const EliminationGroup& group : groups) {
      Nodes own, children;
      for (const std::uint32_t n : group.nodes) own.push_back(nodes[n]);
      for (const std::uint32_t child : group.children) children.push_back(parts[child]);
      if (own.empty()) return children;
      parts.push_back(eliminate(own, children));
    }
    return {parts.back()};
  }

  /// `nodes`: those of the region, rising; they are numbered in that order.
  Graph partOfGraph(const Nodes& nodes, std::uint32_t region) const {
    Graph part;
    part.first = {0};
    for (const std::uint32_t i : nodes) {
      for (std::uint32_t e = graph_.first[i]; e < graph_.first[i + 1]; ++e) {
        const std::uint32_t j = graph_.neighbours[e];
        if (region_[j] != region) continue;
        const auto found = std::lower_bound(nodes.begin(), nodes.end(), j);
        part.neighbours.push_back(static_cast<std::uint32_t>(found - nodes.begin()));
      }
      part.first.push_back(static_cast<std::uint32_t>(part.neighbours.size()));
    }
    return part;
  }

  /// Dissects each connected component; small ones are eliminated several at a time.
  Nodes dissectPieces(const Nodes& nodes, std::uint32_t region) {
    Nodes tops, small;
    for (const std::uint32_t i : nodes) {
      if (region_[i] != region) continue;
      const Nodes piece = levels(i, region);
      for (const std::uint32_t j : piece) region_[j] = 0;
      if (piece.size() > kTooSmall) {
        append(dissect(piece), tops);
        continue;
      }
      append(piece, small);
      if (small.size() <= kTooSmall) continue;
      tops.push_back(eliminate(small, {}));
      small.clear();
    }
    if (!small.empty()) tops.push_back(eliminate(small, {}));
    return tops;
  }

  static void append(const Nodes& some, Nodes& all) {
    all.insert(all.end(), some.begin(), some.end());
  }

  std::uint32_t eliminate(const Nodes& nodes, const Nodes& children) {
    NestedDissection::Part part;
    part.first = static_cast<std::uint32_t>(result_.order.size());
    for (const std::uint32_t i : nodes) {
      result_.places[i] = static_cast<std::uint32_t>(result_.order.size());
      result_.order.push_back(i);
    }
    part.end = static_cast<std::uint32_t>(result_.order.size());
    part.children = children;
    result_.parts.push_back(std::move(part));
    return static_cast<std::uint32_t>(result_.parts.size() - 1);
  }

  /// Nodes of a region by their distance from `start`, which is left in `level_`.
  Nodes levels(std::uint32_t start, std::uint32_t region) {
    for (const std::uint32_t i : last_reached_) level_[i] = kNowhere;
    Nodes reached = {start};
    level_[start] = 0;
    for (std::size_t n = 0; n < reached.size(); ++n) {
      const std::uint32_t i = reached[n];
      for (std::uint32_t e = graph_.first[i]; e < graph_.first[i + 1]; ++e) {
        const std::uint32_t j = graph_.neighbours[e];
        if (region_[j] != region || level_[j] != kNowhere) continue;
        level_[j] = level_[i] + 1;
        reached.push_back(j);
      }
    }
    last_reached_ = reached;
    return reached;
  }

  /// Cuts at the level with the largest ratio of the smaller half to the level's own size. Nodes of
  /// that level without a neighbour behind it go to the half before it.
  Halves cut(const Nodes& reached, std::uint32_t region) const {
    const std::uint32_t depth = level_[reached.back()];
    Nodes first(depth + 2, 0);
    for (const std::uint32_t i : reached) ++first[level_[i] + 1];
    for (std::uint32_t l = 0; l <= depth; ++l) first[l + 1] += first[l];
    double best = 0;
    std::uint32_t chosen = 0;
    for (std::uint32_t l = 1; l < depth; ++l) {
      const double smaller = std::min(first[l], first.back() - first[l + 1]);
      const double quality = smaller / (first[l + 1] - first[l] + 0.02 * reached.size());
      if (quality <= best) continue;
      best = quality;
      chosen = l;
    }
    Halves halves;
    if (chosen == 0) return halves;
    for (const std::uint32_t i : reached) {
      const bool separates = level_[i] == chosen && meets(i, chosen + 1, region);
      (separates             ? halves.separator
       : level_[i] <= chosen ? halves.before
                             : halves.after)
          .push_back(i);
    }
    return halves;
  }

  bool meets(std::uint32_t i, std::uint32_t level, std::uint32_t region) const {
    for (std::uint32_t e = graph_.first[i]; e < graph_.first[i + 1]; ++e) {
      const std::uint32_t j = graph_.neighbours[e];
      if (region_[j] == region && level_[j] == level) return true;
    }
    return false;
  }

  void findBoundaries() {
    for (NestedDissection::Part& part : result_.parts) {
      checkpoint_();
      Nodes& boundary = part.boundary;
      for (const std::uint32_t child : part.children) {
        const Nodes& below = result_.parts[child].boundary;
        boundary.insert(boundary.end(), below.begin(), below.end());
      }
      for (std::uint32_t place = part.first; place < part.end; ++place) {
        const std::uint32_t i = result_.order[place];
        for (std::uint32_t e = graph_.first[i]; e < graph_.first[i + 1]; ++e) {
          boundary.push_back(result_.places[graph_.neighbours[e]]);
        }
      }
      std::sort(boundary.begin(), boundary.end());
      boundary.erase(std::unique(boundary.begin(), boundary.end()), boundary.end());
      boundary.erase(boundary.begin(),
                     std::lower_bound(boundary.begin(), boundary.end(), part.end));
    }
  }

  const Graph& graph_;
  const Checkpoint& checkpoint_;
  Nodes region_;  // to which each node belongs
  Nodes level_;
  Nodes last_reached_;
  std::uint32_t regions_ = 0;
  NestedDissection result_;
};

}  // namespace

NestedDissection nestedDissection(const Graph& graph, const Checkpoint& checkpoint) {
  return Dissection(graph, checkpoint).run();
}

}  // namespace spherical_springs::core
