// Faces of a map to the sphere cut by planes through its centre.
#pragma once

#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

#include "spherical_springs/maps/triangle_mesh.h"

namespace spherical_springs::mesh {

/// Points on a surface and on the sphere that it is mapped to: the vertices first, then those that
/// cuts have added. Two faces that share an edge share the points where it is cut.
class CutFaces {
 public:
  using Index = std::int32_t;
  using Polygon = std::vector<Index>;

  /// Coordinates of the map below 1e-12 count as 0.
  /// @param sphere one unit vector a vertex
  CutFaces(const TriangleMesh& surface, const Points& sphere);

  /// Returns the part of a polygon where a coordinate of the map has a sign or is 0. It is empty
  /// where less than three corners are left.
  /// @param axis 0, 1 or 2 for x, y or z
  /// @param sign 1 or -1
  Polygon cut(const Polygon& polygon, int axis, int sign);

  /// Returns the coordinate along `axis` at which the line between two points of the map crosses
  /// the plane on which the coordinate along `across` is 0; only its sign has a meaning.
  double crossing(Index from, Index to, int across, int axis) const;

  /// Returns a point of the map, with the coordinates that count as 0 at 0.
  Vector3 onSphere(Index point) const { return on_map_[point].normalized(); }
  const std::vector<Vector3>& onSurface() const { return on_surface_; }

 private:
  Index crossingPoint(Index from, Index to, int axis);

  std::vector<Vector3> on_map_, on_surface_;                  // both in the planes of the faces
  std::map<std::tuple<Index, Index, int>, Index> crossings_;  // by ends, in order, and axis
};

}  // namespace spherical_springs::mesh
