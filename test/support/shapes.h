// Closed meshes of genus 0 of many shapes, the same every run.
#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "meshes.h"
#include "scenes.h"
#include "spherical_springs/maps/sphere_map.h"

namespace spherical_springs::mesh::testing {

using core::kPi;
using core::testing::Random;

struct Shape {
  std::string name;
  TriangleMesh mesh;
};

inline TriangleMesh meshOf(const std::vector<Vector3>& vertices,
                           const std::vector<std::array<std::uint32_t, 3>>& faces) {
  TriangleMesh mesh;
  mesh.vertices.resize(3, static_cast<Eigen::Index>(vertices.size()));
  mesh.faces.resize(3, static_cast<Eigen::Index>(faces.size()));
  for (std::size_t v = 0; v < vertices.size(); ++v) mesh.vertices.col(v) = vertices[v];
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (int k = 0; k < 3; ++k) mesh.faces(k, f) = static_cast<std::int32_t>(faces[f][k]);
  }
  return mesh;
}

inline TriangleMesh tetrahedron() {
  return meshOf({{1, 1, 1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, -1}},
                {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {3, 2, 1}});
}

/// An icosphere whose unit vertices are moved by `deform`.
inline TriangleMesh deformedSphere(int level,
                                   const std::function<Vector3(const Vector3&)>& deform) {
  const auto sphere = benchmark_scenes::icosphere(level);
  TriangleMesh mesh = meshOf(sphere.vertices, sphere.faces);
  for (Eigen::Index v = 0; v < mesh.vertices.cols(); ++v) {
    mesh.vertices.col(v) = deform(mesh.vertices.col(v));
  }
  return mesh;
}

/// A tube round the line `centre` of t in [0, 1], closed by a vertex at each end. `width`: half the
/// size of its section along its two normals.
inline TriangleMesh tube(const std::function<Vector3(double)>& centre,
                         const std::function<Eigen::Vector2d(double)>& width, double twist,
                         int rings, int sides) {
  std::vector<Vector3> vertices;
  std::vector<std::array<std::uint32_t, 3>> faces;
  Vector3 normal = Vector3::Zero();
  for (int i = 0; i < rings; ++i) {
    const double t = static_cast<double>(i) / (rings - 1);
    const Vector3 along = (centre(t + 1e-4) - centre(t - 1e-4)).normalized();
    normal = i == 0 ? core::perpendicular(along)
                    : Vector3((normal - normal.dot(along) * along).normalized());
    const Vector3 binormal = along.cross(normal);
    for (int j = 0; j < sides; ++j) {
      const double angle = 2 * kPi * j / sides + twist * t;
      vertices.push_back(centre(t) + width(t)[0] * std::cos(angle) * normal +
                         width(t)[1] * std::sin(angle) * binormal);
    }
  }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i * sides + j % sides); };
  for (int i = 0; i + 1 < rings; ++i) {
    for (int j = 0; j < sides; ++j) {
      faces.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
      faces.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
    }
  }
  const auto first = static_cast<std::uint32_t>(vertices.size()), last = first + 1;
  vertices.push_back(centre(0));
  vertices.push_back(centre(1));
  for (int j = 0; j < sides; ++j) {
    faces.push_back({first, at(0, j + 1), at(0, j)});
    faces.push_back({last, at(rings - 1, j), at(rings - 1, j + 1)});
  }
  return meshOf(vertices, faces);
}

inline TriangleMesh bumps(int level, unsigned seed) {
  Random random(seed);
  const auto centres = random.unitVectors<12>();
  return deformedSphere(level, [=](const Vector3& p) -> Vector3 {
    double radius = 1;
    for (std::size_t i = 0; i < centres.size(); ++i) {
      radius += (i % 2 ? 0.5 : -0.2) * std::exp(-(p - centres[i]).squaredNorm() / 0.05);
    }
    return radius * p;
  });
}

/// Arms that are `length` times as long as the body's radius, in one plane or all about.
inline TriangleMesh star(int level, unsigned seed, bool flat, double length) {
  Random random(seed);
  std::vector<Vector3> directions;
  for (int arm = 0; arm < 5; ++arm) {
    const double angle = 2 * kPi * arm / 5;
    directions.push_back(flat ? Vector3(std::cos(angle), std::sin(angle), 0.1)
                              : random.unitVector());
  }
  return deformedSphere(level, [=](const Vector3& p) -> Vector3 {
    Vector3 place = 0.4 * p;
    for (const Vector3& direction : directions) {
      const double near = std::exp(-(p - direction.normalized()).squaredNorm() / 0.08);
      place += length * near * direction;
    }
    return place;
  });
}

/// A palm with five fingers, cylinders with round ends.
inline TriangleMesh hand(int level, double length) {
  return deformedSphere(level, [=](const Vector3& p) -> Vector3 {
    Vector3 place(p.x(), p.y(), 0.3 * p.z());
    for (int finger = 0; finger < 5; ++finger) {
      const double angle = kPi * (0.1 + 0.2 * finger);
      const Vector3 direction(std::cos(angle), std::sin(angle), 0);
      const double distance = (p - direction).norm();
      if (distance > 0.3) continue;
      place += length * std::min(1., (0.3 - distance) / 0.15) * direction;
    }
    return place;
  });
}

inline TriangleMesh fin(int level, double thickness) {
  return deformedSphere(level, [=](const Vector3& p) -> Vector3 {
    return {p.x(), thickness * p.y(), p.z() + 0.4 * p.x() * p.x()};
  });
}

/// Most vertices crowd about one place.
inline TriangleMesh uneven(int level, double ratio) {
  return deformedSphere(level, [=](const Vector3& p) -> Vector3 {
    const double scale = (1 - p.z()) / (1 + p.z() + 1e-9) * ratio * ratio;
    const double z = (1 - scale) / (1 + scale);
    const double rim = std::sqrt(std::max(0., 1 - z * z));
    const double angle = std::atan2(p.y(), p.x());
    return {rim * std::cos(angle), 2 * rim * std::sin(angle), z};
  });
}

/// Vertices shaken along the surface until many faces are slivers or stand on their heads.
inline TriangleMesh slivers(int level, unsigned seed, double share) {
  Random random(seed);
  const double edge = 1.1 / (1 << level);
  return deformedSphere(level, [=](const Vector3& p) mutable -> Vector3 {
    return (p + share * edge * random.unitVector()).normalized();
  });
}

inline TriangleMesh bar(int rings, int sides, double bend, double twist) {
  return tube(
      [=](double t) -> Vector3 {
        const double angle = bend * (t - 0.5);
        if (std::abs(bend) < 1e-9) return {0, 0, 6 * t};
        return {6 / bend * (std::cos(angle) - 1), 0, 6 / bend * std::sin(angle)};
      },
      [](double) { return Eigen::Vector2d(1, 0.4); }, twist, rings, sides);
}

inline TriangleMesh coil(int rings, int sides, double turns, double radius) {
  return tube(
      [=](double t) -> Vector3 {
        const double angle = 2 * kPi * turns * t;
        return {std::cos(angle), std::sin(angle), 2.5 * radius * turns * t};
      },
      [=](double) { return Eigen::Vector2d(radius, radius); }, 0, rings, sides);
}

/// Fifty, of 500 to 5,000 vertices.
inline std::vector<Shape> fiftyShapes() {
  std::vector<Shape> shapes;
  const auto add = [&](const std::string& name, TriangleMesh mesh) {
    shapes.push_back({name + " " + std::to_string(shapes.size()), std::move(mesh)});
  };
  for (unsigned seed = 1; seed <= 3; ++seed) {
    for (const int level : {3, 4}) {
      add("bumps", bumps(level, seed));
      add("slivers", slivers(level, seed, 0.2 + 0.2 * seed));
    }
    add("star", star(3, seed, false, 2. * seed));
    add("star", star(4, seed, false, 1 + 2. * seed));
    add("uneven", uneven(3, 1 + 2. * seed));
    add("fin", fin(4, 0.3 / (seed * seed)));
    add("hand", hand(4, 0.6 * seed));
    add("bar", bar(40 * seed, 12 + 4 * seed, 0.1 + seed, 0));
    add("twisted bar", bar(50, 12 + 6 * seed, 0.5 * seed, 2. * seed));
    add("coil", coil(60 * seed, 10, 0.7 * seed, 0.2));
  }
  add("flat star", star(3, 0, true, 3));
  add("flat star", star(4, 0, true, 6));
  add("thin coil", coil(300, 6, 2.5, 0.08));
  add("coil", coil(400, 12, 3.5, 0.15));
  add("spindle", bar(12, 200, 0.1, 0));
  add("uneven", uneven(4, 8));
  add("fin", fin(3, 0.01));
  add("hand", hand(3, 1.5));
  add("needle", tube([](double t) { return Vector3(0, 0, 40 * t); },
                     [](double t) { return Eigen::Vector2d(1.02 - t, 1.02 - t); }, 0, 120, 8));
  add("sphere", deformedSphere(3, [](const Vector3& p) { return p; }));
  add("ellipsoid",
      deformedSphere(4, [](const Vector3& p) { return Vector3(p.x(), 3 * p.y(), 0.3 * p.z()); }));
  add("cube",
      deformedSphere(4, [](const Vector3& p) -> Vector3 { return p / p.cwiseAbs().maxCoeff(); }));
  add("wave", deformedSphere(4, [](const Vector3& p) -> Vector3 {
        return (1 + 0.3 * std::sin(12 * p.x()) * std::sin(12 * p.y())) * p;
      }));
  add("pole", tube([](double t) { return Vector3(0, 0, 2 * t - 1); },
                   [](double t) -> Eigen::Vector2d {
                     const double rim = std::sqrt(1 - std::pow(0.99 * (2 * t - 1), 2));
                     return {rim, rim};
                   },
                   0, 40, 80));
  return shapes;
}

inline Eigen::VectorXd sharesOf(const TriangleMesh& mesh) { return faceShares(faceAreas(mesh)); }

/// Directions of vertices of a mesh that is seen whole from its centre, shaken.
inline Points shaken(const TriangleMesh& mesh, double share) {
  Random random(3);
  Points points = mesh.vertices.colwise().normalized();
  for (Eigen::Index v = 0; v < points.cols(); ++v) {
    points.col(v) = (points.col(v) + share * random.unitVector()).normalized();
  }
  return points;
}

}  // namespace spherical_springs::mesh::testing
