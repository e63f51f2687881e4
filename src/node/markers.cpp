#include "node/markers.h"

#include <geometry_msgs/Point.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "geometry/tessellation.h"
#include "springs/strain.h"

namespace spherical_springs {
namespace {

using visualization_msgs::Marker;

// Distances from the centre, in radii; between them is room for the depth of chords.
constexpr double kSphere = 0.995, kTriangles = 0.998, kArcs = 1;
constexpr double kShade = 0.75;  // of triangles, from which arcs and particles then stand out

std_msgs::ColorRGBA colour(double red, double green, double blue) {
  std_msgs::ColorRGBA result;
  result.r = static_cast<float>(red);
  result.g = static_cast<float>(green);
  result.b = static_cast<float>(blue);
  result.a = 1;
  return result;
}

geometry_msgs::Point toPoint(const core::Vector3& p) {
  geometry_msgs::Point point;
  point.x = p.x();
  point.y = p.y();
  point.z = p.z();
  return point;
}

/// `name`: of the topic's namespaces, one for each marker.
Marker marker(const std::string& name, std::int32_t type) {
  Marker result;
  result.ns = name;
  result.type = type;
  result.pose.orientation.w = 1;
  result.frame_locked = true;
  result.color = colour(1, 1, 1);
  return result;
}

/// RViz refuses lists without points.
Marker orNothing(Marker marker) {
  marker.action = marker.points.empty() ? Marker::DELETE : Marker::ADD;
  return marker;
}

/// A mean distance between neighbours among `count` particles [rad], as if evenly spread.
double spacing(Eigen::Index count) { return std::sqrt(4 * core::kPi / std::max<double>(count, 1)); }

double particleDiameter(Eigen::Index count) { return std::min(0.05, 0.3 * spacing(count)); }
double lineWidth(Eigen::Index count) { return std::min(0.01, 0.06 * spacing(count)); }

template <std::size_t Corners, class Visitor>
void forEachSpring(const core::System& system, const core::Points& positions, Visitor&& visit) {
  core::forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    if constexpr (Spring::kCorners == Corners) {
      for (const Spring& spring : system.springs<Spring>()) {
        visit(spring, core::System::points(spring, positions));
      }
    }
  });
}

/// The longest side of a piece: as short as the line's width asks for, or as the most pieces allow.
template <std::size_t Corners>
double longestPiece(const core::System& system, const core::Points& positions) {
  constexpr double kMostPieces = 3e5;
  const double longest = core::pieceWithin(lineWidth(system.particleCount()) / 10);
  double pieces = 0;
  forEachSpring<Corners>(system, positions, [&](const auto&, const auto& p) {
    if constexpr (Corners == 2) {
      pieces += (p[0] - p[1]).norm() / longest;
    } else {
      const double squared_side = std::max(
          {(p[0] - p[1]).squaredNorm(), (p[1] - p[2]).squaredNorm(), (p[2] - p[0]).squaredNorm()});
      pieces +=
          4 * squared_side / (longest * longest);  // halving makes some shorter than they need be
    }
  });
  return longest * std::pow(std::max(1., pieces / kMostPieces), 1. / (Corners - 1));
}

/// `append(points, longest, pieces)` appends the pieces of one spring's shape.
template <std::size_t Corners, class Append>
void fill(const core::System& system, const core::Points& positions, double radius, double shade,
          const Append& append, Marker& marker) {
  const double longest = longestPiece<Corners>(system, positions);
  std::vector<core::Vector3> pieces;
  forEachSpring<Corners>(system, positions, [&](const auto& spring, const auto& points) {
    pieces.clear();
    append(points, longest, pieces);
    for (const core::Vector3& p : pieces) marker.points.push_back(toPoint(radius * p));
    marker.colors.resize(marker.points.size(), strainColour(core::strain(spring, points), shade));
  });
}

}  // namespace

std_msgs::ColorRGBA strainColour(double strain, double shade) {
  const core::Vector3 smaller(0.2, 0.55, 1), at_rest(1, 1, 1), larger(1, 0.55, 0);
  const double share = std::min(1., std::abs(strain));
  const core::Vector3 c = shade * (at_rest + share * ((strain < 0 ? smaller : larger) - at_rest));
  return colour(c.x(), c.y(), c.z());
}

Marker sphereMarker(double radius) {
  Marker result = marker("sphere", Marker::SPHERE);
  result.scale.x = result.scale.y = result.scale.z = 2 * kSphere * radius;
  result.color = colour(0.2, 0.22, 0.25);
  return result;
}

Marker particlesMarker(const core::System& system, const core::Points& positions, double radius) {
  Marker result = marker("particles", Marker::SPHERE_LIST);
  const Eigen::Index count = system.particleCount();
  result.scale.x = result.scale.y = result.scale.z = particleDiameter(count) * radius;
  bool any_pinned = false;
  result.points.reserve(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    result.points.push_back(toPoint(radius * positions.col(i)));
    any_pinned = any_pinned || system.pinned(i);
  }
  if (any_pinned) {
    result.colors.assign(count, result.color);
    for (Eigen::Index i = 0; i < count; ++i) {
      if (system.pinned(i)) result.colors[i] = colour(0, 0, 0);
    }
  }
  return orNothing(std::move(result));
}

Marker arcsMarker(const core::System& system, const core::Points& positions, double radius) {
  Marker result = marker("arcs", Marker::LINE_LIST);
  result.scale.x = lineWidth(system.particleCount()) * radius;
  const auto append = [](const auto& p, double longest, std::vector<core::Vector3>& pieces) {
    core::appendArc(p[0], p[1], longest, pieces);
  };
  fill<2>(system, positions, kArcs * radius, 1, append, result);
  return orNothing(std::move(result));
}

Marker trianglesMarker(const core::System& system, const core::Points& positions, double radius) {
  Marker result = marker("triangles", Marker::TRIANGLE_LIST);
  result.scale.x = result.scale.y = result.scale.z = 1;
  const auto append = [](const auto& p, double longest, std::vector<core::Vector3>& pieces) {
    core::appendTriangle(p[0], p[1], p[2], longest, pieces);
  };
  fill<3>(system, positions, kTriangles * radius, kShade, append, result);
  return orNothing(std::move(result));
}

}  // namespace spherical_springs
