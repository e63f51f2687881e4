#include "maps/handle.h"

#include <algorithm>

namespace spherical_springs::mesh {
namespace {

using Index = HalfEdges::Index;

/// Half-edges of each vertex's origin, one each.
std::vector<Index> anyHalfEdges(const HalfEdges& edges) {
  std::vector<Index> any;
  for (Index h = 0; h < edges.size(); ++h) {
    if (edges.origin(h) >= static_cast<Index>(any.size())) {
      any.resize(edges.origin(h) + 1, HalfEdges::kNone);
    }
    any[edges.origin(h)] = h;
  }
  return any;
}

/// Shortest paths from a vertex, and which edges neither they nor a tree of faces use.
class Trees {
 public:
  Trees(const HalfEdges& edges, const std::vector<Index>& any, Index root)
      : edges_(edges),
        used_(edges.size(), false),
        parents_(any.size(), HalfEdges::kNone),
        depths_(any.size(), 0) {
    growVertices(any, root);
    growFaces();
  }

  /// Returns the shortest of the paths that an edge outside of both trees closes.
  std::vector<Index> shortestPath() const {
    Index best = HalfEdges::kNone, shortest = 0;
    for (Index h = 0; h < edges_.size(); ++h) {
      if (used_[h] || h > edges_.twin(h)) continue;
      const Index length = lengthThrough(h);
      if (best != HalfEdges::kNone && length >= shortest) continue;
      best = h;
      shortest = length;
    }
    return pathThrough(best);
  }

 private:
  void use(Index h) { used_[h] = used_[edges_.twin(h)] = true; }

  void growVertices(const std::vector<Index>& any, Index root) {
    std::vector<Index> reached = {root};
    parents_[root] = root;
    for (std::size_t i = 0; i < reached.size(); ++i) {
      const Index first = any[reached[i]];
      Index h = first;
      do {
        const Index v = edges_.target(h);
        if (parents_[v] == HalfEdges::kNone) {
          parents_[v] = reached[i];
          depths_[v] = depths_[reached[i]] + 1;
          use(h);
          reached.push_back(v);
        }
        h = edges_.turned(h);
      } while (h != first);
    }
  }

  void growFaces() {
    std::vector<bool> seen(edges_.size() / 3, false);
    std::vector<Index> reached = {0};
    seen[0] = true;
    for (std::size_t i = 0; i < reached.size(); ++i) {
      for (Index h = 3 * reached[i]; h < 3 * reached[i] + 3; ++h) {
        const Index f = HalfEdges::face(edges_.twin(h));
        if (used_[h] || seen[f]) continue;
        seen[f] = true;
        use(h);
        reached.push_back(f);
      }
    }
  }

  Index meetingPoint(Index v, Index w) const {
    while (v != w) {
      Index& deeper = depths_[v] >= depths_[w] ? v : w;
      deeper = parents_[deeper];
    }
    return v;
  }

  Index lengthThrough(Index h) const {
    const Index v = edges_.origin(h), w = edges_.target(h);
    return depths_[v] + depths_[w] + 1 - 2 * depths_[meetingPoint(v, w)];
  }

  std::vector<Index> pathThrough(Index h) const {
    const Index v = edges_.origin(h), w = edges_.target(h), middle = meetingPoint(v, w);
    std::vector<Index> path, back;
    for (Index u = v; u != middle; u = parents_[u]) path.push_back(u);
    path.push_back(middle);
    for (Index u = w; u != middle; u = parents_[u]) back.push_back(u);
    path.insert(path.end(), back.rbegin(), back.rend());
    return path;
  }

  const HalfEdges& edges_;
  std::vector<bool> used_;  // by one of the trees
  std::vector<Index> parents_, depths_;
};

}  // namespace

std::vector<Index> pathRoundAHandle(const HalfEdges& edges) {
  const std::vector<Index> any = anyHalfEdges(edges);
  std::vector<Index> path = Trees(edges, any, edges.origin(0)).shortestPath();
  // From a vertex on the path, paths round the same handle are shorter.
  for (int again = 0; again < 3; ++again) {
    std::vector<Index> nearer = Trees(edges, any, path.front()).shortestPath();
    if (nearer.size() >= path.size()) break;
    path = std::move(nearer);
  }
  return path;
}

}  // namespace spherical_springs::mesh
