// Meshes for tests.
#pragma once

#include "meshes.h"
#include "spherical_springs/maps/triangle_mesh.h"

namespace mesh_scenes {

/// The benchmark's.
inline spherical_springs::mesh::TriangleMesh icosphere(int level) {
  const benchmark_scenes::Mesh from = benchmark_scenes::icosphere(level);
  spherical_springs::mesh::TriangleMesh mesh{
      spherical_springs::mesh::Points(3, from.vertices.size()),
      spherical_springs::mesh::Faces(3, from.faces.size())};
  for (std::size_t i = 0; i < from.vertices.size(); ++i) mesh.vertices.col(i) = from.vertices[i];
  for (std::size_t f = 0; f < from.faces.size(); ++f) {
    const auto& [a, b, c] = from.faces[f];
    mesh.faces.col(f) << a, b, c;
  }
  return mesh;
}

}  // namespace mesh_scenes
