// Which faces and vertices of a triangle mesh meet.
#pragma once

#include <cstdint>
#include <vector>

#include "maps/mesh_names.h"
#include "spherical_springs/maps/triangle_mesh.h"

namespace spherical_springs::mesh {

/// Half-edge 3 f + k runs along face f, from its vertex k to the next.
class HalfEdges {
 public:
  using Index = std::int32_t;
  static constexpr Index kNone = -1;

  /// Two half-edges are twins where they run between the same vertices, opposite ways. `faces` must
  /// live longer.
  /// @throw std::invalid_argument, in the words of `names`, for an edge that two half-edges run
  /// along the same way.
  explicit HalfEdges(const Faces& faces, const MeshNames& names = {});

  Index size() const { return static_cast<Index>(twins_.size()); }
  Index twin(Index h) const { return twins_[h]; }  ///< kNone at a boundary
  Index origin(Index h) const { return faces_(h % 3, h / 3); }
  Index target(Index h) const { return origin(next(h)); }
  static Index next(Index h) { return h % 3 == 2 ? h - 2 : h + 1; }
  static Index previous(Index h) { return h % 3 == 0 ? h + 2 : h - 1; }
  static Index face(Index h) { return h / 3; }

  /// The next half-edge of the same origin, counter-clockwise.
  Index turned(Index h) const { return twin(previous(h)); }

 private:
  void joinTwins(std::vector<Index>::iterator begin, std::vector<Index>::iterator end,
                 const MeshNames& names);

  const Faces& faces_;
  std::vector<Index> twins_;
};

}  // namespace spherical_springs::mesh
