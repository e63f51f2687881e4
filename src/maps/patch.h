// Parts of a map that are worked on while what is round them stays.
#pragma once

#include <cstdint>
#include <vector>

#include "maps/half_edges.h"

namespace spherical_springs::mesh {

struct Patch {
  /// Vertices of the mesh by their number in the patch: the free ones from the middle outwards,
  /// then those next to them.
  std::vector<std::int32_t> vertices;
  std::int32_t free = 0;
  Faces faces;             ///< all round the free vertices, of numbers
  Eigen::VectorXd shares;  ///< of those

  Points of(const Points& map) const;
  void putInto(Points& map, const Points& points) const;  ///< the free ones
};

/// Cuts patches out of a mesh none of which has a face with a free vertex of another.
class PatchCutter {
 public:
  /// Cuts patches of a closed mesh. The arguments must live longer.
  PatchCutter(const Faces& faces, const Eigen::VectorXd& shares, std::int32_t vertices);

  /// About a face, up to `size` free vertices, or as many more as one of them has neighbours. None
  /// is free that has more than `size` neighbours, is in another patch or next to one.
  Patch cut(Eigen::Index face, std::size_t size);

  /// Forgets the patches before.
  void begin();

 private:
  template <class Body>
  void forEachNeighbour(std::int32_t vertex, const Body& body) const;

  const Faces& faces_;
  const Eigen::VectorXd& shares_;
  HalfEdges half_edges_;
  std::vector<HalfEdges::Index> outgoing_;  // one of each vertex
  std::vector<std::size_t> valences_;       // faces round each vertex
  std::vector<char> taken_;                 // vertices of patches and next to them
};

}  // namespace spherical_springs::mesh
