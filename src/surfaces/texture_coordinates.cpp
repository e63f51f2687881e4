#include "surfaces/texture_coordinates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>
#include <vector>

#include "surfaces/cut_faces.h"

namespace spherical_springs::mesh {
namespace {

using Index = CutFaces::Index;
using Polygon = CutFaces::Polygon;

constexpr int kX = 0, kY = 1, kZ = 2;

struct Part {
  Polygon corners;
  Side side;
};

std::vector<Part> cut(CutFaces& faces, const std::vector<Part>& parts, int axis) {
  std::vector<Part> result;
  for (const Part& part : parts) {
    for (const int sign : {1, -1}) {
      Polygon polygon = faces.cut(part.corners, axis, sign);
      if (polygon.empty()) continue;
      result.push_back({std::move(polygon), part.side});
      result.back().side[axis] = sign;
    }
  }
  return result;
}

/// How a polygon meets the plane of the meridians 0 and 180 degrees, if it lies on both sides of
/// it.
struct SeamPlane {
  bool is_crossed = false;  // at 180 degrees, or at a pole in the middle of an edge
  bool has_pole_inside = false;
};

SeamPlane seamPlaneOf(const CutFaces& faces, const Polygon& polygon) {
  bool east = false, west = false, front = false, back = false, pole_on_edge = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Index from = polygon[i], to = polygon[(i + 1) % polygon.size()];
    const double y = faces.onSphere(from)[kY];
    east |= y > 0;
    west |= y < 0;
    double x = 0;
    if (y == 0) {
      x = faces.onSphere(from)[kX];
    } else if (y * faces.onSphere(to)[kY] < 0) {
      x = faces.crossing(from, to, kY, kX);
      pole_on_edge |= x == 0;
    }
    front |= x > 0;
    back |= x < 0;
  }
  if (!east || !west) return {};
  return {back || pole_on_edge, back && front};
}

/// Parts of a face with one place for each point, but for poles.
std::vector<Part> partsOf(CutFaces& faces, const Polygon& face, Projection projection) {
  std::vector<Part> parts = {{face, {1, 1, 1}}};
  if (projection == Projection::equal_area_octahedron) {
    for (const int axis : {kX, kY, kZ}) parts = cut(faces, parts, axis);
    return parts;
  }
  const SeamPlane seam = seamPlaneOf(faces, face);
  if (seam.is_crossed) {
    parts = cut(faces, parts, kY);
  } else if (std::any_of(face.begin(), face.end(),
                         [&](Index point) { return faces.onSphere(point)[kY] < 0; })) {
    parts.front().side[kY] = -1;
  }
  return seam.has_pole_inside ? cut(faces, parts, kX) : parts;
}

/// Collects faces and places.
class Chart {
 public:
  Chart(CutFaces& faces, Projection projection) : faces_(faces), projection_(projection) {}

  void add(const Part& part) {
    const Polygon& corners = part.corners;
    const auto pole =
        std::find_if(corners.begin(), corners.end(), [&](Index point) { return isPole(point); });
    // Triangles with a common corner, at the pole if there is one.
    const std::size_t first = pole == corners.end() ? 0 : pole - corners.begin();
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
      add({corners[first], corners[(first + i) % corners.size()],
           corners[(first + i + 1) % corners.size()]},
          part.side);
    }
  }

  TexturedSurface result() const {
    const auto columns = [](const std::vector<std::array<Index, 3>>& list) {
      Faces matrix(3, static_cast<Eigen::Index>(list.size()));
      for (std::size_t f = 0; f < list.size(); ++f) {
        matrix.col(f) << list[f][0], list[f][1], list[f][2];
      }
      return matrix;
    };
    TexturedSurface textured;
    textured.surface.vertices.resize(3, static_cast<Eigen::Index>(faces_.onSurface().size()));
    for (std::size_t v = 0; v < faces_.onSurface().size(); ++v) {
      textured.surface.vertices.col(v) = faces_.onSurface()[v];
    }
    textured.surface.faces = columns(triangles_);
    textured.places.resize(2, static_cast<Eigen::Index>(places_.size()));
    for (std::size_t p = 0; p < places_.size(); ++p) textured.places.col(p) = places_[p];
    textured.corners = columns(corners_);
    return textured;
  }

 private:
  bool isPole(Index point) const {
    const Vector3& p = faces_.onSphere(point);
    return projection_ != Projection::equal_area_octahedron && p.x() == 0 && p.y() == 0;
  }

  /// At most one corner is a pole, the first.
  void add(const std::array<Index, 3>& triangle, const Side& side) {
    std::array<Index, 3> corners;
    for (int k = 0; k < 3; ++k) {
      if (!isPole(triangle[k])) corners[k] = place(triangle[k], side);
    }
    if (isPole(triangle[0])) {
      const double v = placeOf(projection_, faces_.onSphere(triangle[0]), side).y();
      corners[0] = static_cast<Index>(places_.size());
      places_.push_back({(places_[corners[1]].x() + places_[corners[2]].x()) / 2, v});
    }
    triangles_.push_back(triangle);
    corners_.push_back(corners);
  }

  Index place(Index point, const Side& side) {
    const Eigen::Vector2d place = placeOf(projection_, faces_.onSphere(point), side);
    const auto entry =
        known_.try_emplace({point, place.x(), place.y()}, static_cast<Index>(places_.size()));
    if (entry.second) places_.push_back(place);
    return entry.first->second;
  }

  CutFaces& faces_;
  const Projection projection_;
  std::vector<std::array<Index, 3>> triangles_, corners_;
  std::vector<Eigen::Vector2d> places_;
  std::map<std::tuple<Index, double, double>, Index> known_;
};

}  // namespace

TexturedSurface textured(const TriangleMesh& surface, const Points& sphere, Projection projection) {
  CutFaces faces(surface, sphere);
  Chart chart(faces, projection);
  for (Eigen::Index f = 0; f < surface.faces.cols(); ++f) {
    const auto face = surface.faces.col(f);
    for (const Part& part : partsOf(faces, {face[0], face[1], face[2]}, projection)) {
      chart.add(part);
    }
  }
  return chart.result();
}

double spreadOfTexelDensity(const TexturedSurface& textured) {
  const Values areas = faceAreas(textured.surface);
  double total = 0, mean = 0, square = 0;
  for (Eigen::Index f = 0; f < areas.size(); ++f) {
    const auto corner = [&](int k) { return textured.places.col(textured.corners(k, f)); };
    const Eigen::Vector2d ab = corner(1) - corner(0), ac = corner(2) - corner(0);
    const double texels = std::abs(ab.x() * ac.y() - ab.y() * ac.x()) / 2;
    if (areas[f] == 0 || texels == 0) continue;  // slivers of rounding
    const double density = std::log(texels / areas[f]);
    total += areas[f];
    mean += areas[f] * density;
    square += areas[f] * density * density;
  }
  mean /= total;
  return std::sqrt(std::max(0., square / total - mean * mean));
}

}  // namespace spherical_springs::mesh
