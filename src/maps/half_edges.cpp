#include "maps/half_edges.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <tuple>

namespace spherical_springs::mesh {

HalfEdges::HalfEdges(const Faces& faces, const MeshNames& names)
    : faces_(faces), twins_(3 * faces.cols(), kNone) {
  const auto lower = [&](Index h) { return std::min(origin(h), target(h)); };
  std::vector<Index> first(faces.size() == 0 ? 1 : faces.maxCoeff() + 2, 0);
  for (Index h = 0; h < size(); ++h) ++first[lower(h) + 1];
  for (std::size_t v = 1; v < first.size(); ++v) first[v] += first[v - 1];
  std::vector<Index> sorted(twins_.size()), next = first;
  for (Index h = 0; h < size(); ++h) sorted[next[lower(h)]++] = h;
  for (std::size_t v = 0; v + 1 < first.size(); ++v) {
    joinTwins(sorted.begin() + first[v], sorted.begin() + first[v + 1], names);
  }
}

/// `begin` to `end`: the half-edges that have the lower of their ends in common.
void HalfEdges::joinTwins(std::vector<Index>::iterator begin, std::vector<Index>::iterator end,
                          const MeshNames& names) {
  const auto upper = [&](Index h) { return std::max(origin(h), target(h)); };
  std::sort(begin, end, [&](Index g, Index h) {
    return std::make_tuple(upper(g), origin(g), g) < std::make_tuple(upper(h), origin(h), h);
  });
  for (auto i = begin; i != end && i + 1 != end; ++i) {
    const Index g = *i, h = *(i + 1);
    if (upper(g) != upper(h)) continue;
    if (origin(g) == origin(h)) {
      throw std::invalid_argument(
          names.edge(origin(g), target(g)) + " runs the same way in " + names.face(face(g)) +
          " and " + names.face(face(h)) +
          "; allowed: two faces an edge, both counter-clockwise from outside");
    }
    twins_[g] = h;
    twins_[h] = g;
  }
}

}  // namespace spherical_springs::mesh
