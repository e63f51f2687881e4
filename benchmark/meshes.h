// Meshes and networks for measurements, the same every run.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <unordered_map>
#include <utility>
#include <vector>

#include "spherical_springs/scene.h"

namespace benchmark_scenes {

using spherical_springs::core::AngleSpring;
using spherical_springs::core::Particle;
using spherical_springs::core::SolidAngleSpring;
using spherical_springs::core::SpringLists;
using spherical_springs::core::Vector3;

struct Mesh {
  std::vector<Vector3> vertices;  ///< unit vectors
  std::vector<std::array<std::uint32_t, 3>> faces;
  std::vector<std::array<std::uint32_t, 2>> edges;
};

namespace detail {

inline Mesh icosahedron() {
  const double t = (1 + std::sqrt(5.)) / 2;
  Mesh mesh;
  mesh.vertices = {{-1, t, 0},  {1, t, 0},  {-1, -t, 0}, {1, -t, 0}, {0, -1, t},  {0, 1, t},
                   {0, -1, -t}, {0, 1, -t}, {t, 0, -1},  {t, 0, 1},  {-t, 0, -1}, {-t, 0, 1}};
  for (Vector3& vertex : mesh.vertices) vertex.normalize();
  mesh.faces = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  return mesh;
}

/// Cuts every face into four; the edges are those of the result.
inline Mesh subdivided(const Mesh& mesh) {
  std::unordered_map<std::uint64_t, std::uint32_t> middles;
  middles.reserve(mesh.faces.size() * 3 / 2);
  Mesh result;
  result.vertices = mesh.vertices;
  const auto middle = [&](std::uint64_t a, std::uint64_t b) {
    const auto [found, is_new] =
        middles.try_emplace(std::min(a, b) << 32 | std::max(a, b), result.vertices.size());
    if (is_new) {
      result.vertices.push_back((result.vertices[a] + result.vertices[b]).normalized());
    }
    return found->second;
  };
  for (const auto& [a, b, c] : mesh.faces) {
    const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    result.faces.insert(result.faces.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
  }
  return result;
}

/// Cuts every face into n^2. A vertex is known by its shares of the corners that it lies between.
inline Mesh divided(const Mesh& mesh, std::uint32_t n) {
  using Share = std::pair<std::uint32_t, std::uint32_t>;  // how much, and of which corner
  std::map<std::array<Share, 3>, std::uint32_t> known;
  Mesh result;
  for (const auto& [a, b, c] : mesh.faces) {
    const auto vertex = [&, a = a, b = b, c = c](std::uint32_t i, std::uint32_t j) {
      std::array<Share, 3> shares = {{{n - i - j, a}, {i, b}, {j, c}}};
      Vector3 sum = Vector3::Zero();
      for (auto& [share, corner] : shares) {
        sum += share * mesh.vertices[corner];
        if (share == 0) corner = 0;
      }
      std::sort(shares.begin(), shares.end());
      const auto [found, is_new] = known.try_emplace(shares, result.vertices.size());
      if (is_new) result.vertices.push_back(sum.normalized());
      return found->second;
    };
    for (std::uint32_t i = 0; i < n; ++i) {
      for (std::uint32_t j = 0; i + j < n; ++j) {
        result.faces.push_back({vertex(i, j), vertex(i + 1, j), vertex(i, j + 1)});
        if (i + j + 1 == n) continue;
        result.faces.push_back({vertex(i + 1, j + 1), vertex(i, j + 1), vertex(i + 1, j)});
      }
    }
  }
  return result;
}

inline void addEdges(Mesh& mesh) {
  for (const auto& face : mesh.faces) {
    for (int i = 0; i < 3; ++i) {
      if (face[i] < face[(i + 1) % 3]) mesh.edges.push_back({face[i], face[(i + 1) % 3]});
    }
  }
}

}  // namespace detail

/// An icosahedron subdivided `level` times: 10 * 4^level + 2 vertices.
inline Mesh icosphere(int level) {
  Mesh mesh = detail::icosahedron();
  for (int i = 0; i < level; ++i) mesh = detail::subdivided(mesh);
  detail::addEdges(mesh);
  return mesh;
}

/// An icosahedron with its edges cut into `frequency` pieces: 10 * frequency^2 + 2 vertices.
inline Mesh geodesicGrid(std::uint32_t frequency) {
  Mesh mesh = detail::divided(detail::icosahedron(), frequency);
  detail::addEdges(mesh);
  return mesh;
}

}  // namespace benchmark_scenes
