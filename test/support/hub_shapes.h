// Closed meshes in which some vertices have very many faces.
#pragma once

#include "shapes.h"

namespace spherical_springs::mesh::testing {

/// Two vertices with `faces` faces each, over and under a ring.
inline TriangleMesh doublePyramid(std::uint32_t faces) {
  std::vector<Vector3> vertices = {Vector3::UnitZ(), -Vector3::UnitZ()};
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::uint32_t i = 0; i < faces; ++i) {
    const double angle = 2 * kPi * i / faces;
    vertices.push_back({std::cos(angle), std::sin(angle), 0});
    const std::uint32_t here = 2 + i, next = 2 + (i + 1) % faces;
    triangles.push_back({0, here, next});
    triangles.push_back({1, next, here});
  }
  return meshOf(vertices, triangles);
}

/// A half of a sphere of rings of as many vertices, with one vertex at its top and one in the
/// middle of its base.
inline TriangleMesh dome(int rings, int sides) {
  return tube([](double t) { return Vector3(0, 0, t); },
              [](double t) -> Eigen::Vector2d {
                const double radius = std::sqrt(1 - 0.999 * t * t);
                return {radius, radius};
              },
              0, rings, sides);
}

/// A dome of rings each of which has half as many vertices as the one below it.
inline TriangleMesh gradedDome(std::uint32_t sides) {
  std::vector<Vector3> vertices = {Vector3::Zero()};
  std::vector<std::array<std::uint32_t, 3>> faces;
  const auto addRing = [&](std::uint32_t count) {
    const double height = 1 - static_cast<double>(count) / sides;
    const double radius = std::sqrt(1 - 0.99 * height * height);
    for (std::uint32_t i = 0; i < count; ++i) {
      const double angle = 2 * kPi * i / count;
      vertices.push_back({radius * std::cos(angle), radius * std::sin(angle), height});
    }
    return static_cast<std::uint32_t>(vertices.size()) - count;
  };
  std::uint32_t below = addRing(sides);
  for (std::uint32_t i = 0; i < sides; ++i)
    faces.push_back({0, below + (i + 1) % sides, below + i});
  std::uint32_t count = sides;
  for (; count % 2 == 0 && count > 6; count /= 2) {
    const std::uint32_t above = addRing(count / 2);
    for (std::uint32_t i = 0; i < count / 2; ++i) {
      const std::uint32_t a = below + 2 * i, b = a + 1, c = below + (2 * i + 2) % count;
      const std::uint32_t here = above + i, next = above + (i + 1) % (count / 2);
      faces.push_back({a, b, here});
      faces.push_back({b, c, next});
      faces.push_back({b, next, here});
    }
    below = above;
  }
  const auto top = static_cast<std::uint32_t>(vertices.size());
  vertices.push_back({0, 0, 1.1});
  for (std::uint32_t i = 0; i < count; ++i) {
    faces.push_back({below + i, below + (i + 1) % count, top});
  }
  return meshOf(vertices, faces);
}

/// Each vertex but the first four stands in a face of those before it, so that a few have a large
/// part of all faces.
inline TriangleMesh stacked(std::size_t count) {
  Random random(1);
  const TriangleMesh start = tetrahedron();
  std::vector<Vector3> vertices;
  std::vector<std::array<std::uint32_t, 3>> faces;
  for (Eigen::Index i = 0; i < 4; ++i) {
    vertices.push_back(start.vertices.col(i).normalized());
    const Eigen::Matrix<std::uint32_t, 3, 1> face = start.faces.col(i).cast<std::uint32_t>();
    faces.push_back({face[0], face[1], face[2]});
  }
  while (vertices.size() < count) {
    auto& face = faces[random.below(static_cast<std::uint32_t>(faces.size()))];
    const auto [a, b, c] = face;
    const auto d = static_cast<std::uint32_t>(vertices.size());
    vertices.push_back((vertices[a] + vertices[b] + vertices[c]).normalized());
    face = {a, b, d};
    faces.push_back({b, c, d});
    faces.push_back({c, a, d});
  }
  return meshOf(vertices, faces);
}

/// Meshes in which a vertex has a large part of all faces, or all are close to it; of some `size`
/// vertices.
inline std::vector<Shape> shapesWithHubs(std::uint32_t size) {
  return {{"double pyramid", doublePyramid(size)},
          {"dome", dome(3, static_cast<int>(size / 3))},
          {"graded dome", gradedDome(size / 2 / 64 * 64)},
          {"stacked", stacked(size)}};
}

}  // namespace spherical_springs::mesh::testing
