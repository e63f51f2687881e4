#include "half_edges.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <tuple>

namespace spherical_springs::mesh {

HalfEdges::HalfEdges(const Faces& faces) : faces_(faces), twins_(3 * faces.cols(), kNone) {
  const auto ends = [&](Index h) {
    return std::make_pair(std::min(origin(h), target(h)), std::max(origin(h), target(h)));
  };
  std::vector<Index> sorted(twins_.size());
  for (Index h = 0; h < size(); ++h) sorted[h] = h;
  std::sort(sorted.begin(), sorted.end(), [&](Index g, Index h) {
    return std::make_tuple(ends(g), origin(g), g) < std::make_tuple(ends(h), origin(h), h);
  });
  for (std::size_t i = 0; i + 1 < sorted.size(); ++i) {
    const Index g = sorted[i], h = sorted[i + 1];
    if (ends(g) != ends(h)) continue;
    if (origin(g) == origin(h)) {
      throw std::invalid_argument(
          "edge " + std::to_string(origin(g)) + "-" + std::to_string(target(g)) +
          " runs the same way in faces " + std::to_string(face(g)) + " and " +
          std::to_string(face(h)) +
          "; allowed: two faces an edge, both counter-clockwise from outside");
    }
    twins_[g] = h;
    twins_[h] = g;
  }
}

}  // namespace spherical_springs::mesh
