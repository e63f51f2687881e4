#include "surfaces/cut_faces.h"

#include <algorithm>
#include <cmath>

namespace spherical_springs::mesh {

CutFaces::CutFaces(const TriangleMesh& surface, const Points& sphere) {
  constexpr double kZero = 1e-12;
  for (Eigen::Index v = 0; v < sphere.cols(); ++v) {
    Vector3 place = sphere.col(v);
    for (int k = 0; k < 3; ++k) {
      if (std::abs(place[k]) < kZero) place[k] = 0;
    }
    on_map_.push_back(place);
    on_surface_.push_back(surface.vertices.col(v));
  }
}

double CutFaces::crossing(Index from, Index to, int across, int axis) const {
  const Vector3 &p = on_map_[from], &q = on_map_[to];
  return p[axis] * std::abs(q[across]) + q[axis] * std::abs(p[across]);
}

/// The point at which an edge crosses a plane. It divides the straight edge of the surface as the
/// chord of the map, so that neighbours agree.
CutFaces::Index CutFaces::crossingPoint(Index from, Index to, int axis) {
  const auto ends = std::minmax(from, to);
  const auto place =
      crossings_.try_emplace({ends.first, ends.second, axis}, static_cast<Index>(on_map_.size()));
  if (!place.second) return place.first->second;
  const Vector3 &p = on_map_[ends.first], &q = on_map_[ends.second];
  const double share = p[axis] / (p[axis] - q[axis]);
  Vector3 on_map = p + share * (q - p);
  on_map[axis] = 0;
  const Vector3 &a = on_surface_[ends.first], &b = on_surface_[ends.second];
  const Vector3 on_surface = a + share * (b - a);
  on_map_.push_back(on_map);
  on_surface_.push_back(on_surface);
  return place.first->second;
}

CutFaces::Polygon CutFaces::cut(const Polygon& polygon, int axis, int sign) {
  Polygon part;
  bool has_inside = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Index from = polygon[i], to = polygon[(i + 1) % polygon.size()];
    const double here = sign * on_map_[from][axis], there = sign * on_map_[to][axis];
    if (here >= 0) part.push_back(from);
    has_inside |= here > 0;
    if (here * there < 0) part.push_back(crossingPoint(from, to, axis));
  }
  if (!has_inside || part.size() < 3) part.clear();
  return part;
}

}  // namespace spherical_springs::mesh
