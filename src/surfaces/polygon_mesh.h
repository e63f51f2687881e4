// Surfaces as files hold them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "spherical_springs/maps/triangle_mesh.h"

namespace spherical_springs::mesh {

/// A surface of polygons. Each corner is a vertex; nothing else is checked.
struct PolygonMesh {
  std::vector<Vector3> vertices;      ///< [m], finite
  std::vector<std::int32_t> corners;  ///< indices of vertices, face after face
  std::vector<std::size_t> ends;      ///< of each face: where its corners end in `corners`

  std::int32_t first_number = 0;     ///< the number by which the file calls its first vertex
  bool numbers_vertices = true;      ///< whether the file tells vertices apart by numbers
  std::vector<std::uint32_t> lines;  ///< the line of each face, from 1; empty in other files

  std::int32_t faces() const { return static_cast<std::int32_t>(ends.size()); }
  std::size_t begin(std::int32_t face) const { return face == 0 ? 0 : ends[face - 1]; }
};

}  // namespace spherical_springs::mesh
