// Triangle meshes that remember which parts of a file they come from.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "maps/mesh_names.h"
#include "surfaces/polygon_mesh.h"

namespace spherical_springs::mesh {

/// A triangle mesh made from a file. Vertices and faces are in the order of the file; those that no
/// file has come last.
struct Surface {
  static constexpr std::int32_t kNone = -1;

  TriangleMesh mesh;
  std::vector<std::int32_t> file_vertices;  ///< of each vertex: its index in the file, or kNone
  std::vector<std::int32_t> file_faces;     ///< of each triangle: its face in the file, or kNone
};

/// Cuts the polygons of a file into triangles with the same corners, those in a plane without
/// overlap: always the corner that the shortest line cuts off.
/// @throw std::invalid_argument for more triangles than 32 bits count.
Surface triangulated(const PolygonMesh& file);

/// Names parts of a surface by the numbers of its file and by coordinates, and remedies by the
/// options of relax_mesh.
class FileNames : public MeshNames {
 public:
  /// The arguments must live longer.
  FileNames(const PolygonMesh& file, const Surface& surface) : file_(file), surface_(surface) {}

  std::string vertex(std::int32_t index) const override;
  std::string face(std::int32_t index) const override;
  std::string edge(std::int32_t from, std::int32_t to) const override;
  std::string remedy(MeshFault fault, std::int32_t size) const override;

 private:
  std::string numbered(std::int32_t index) const;

  const PolygonMesh& file_;
  const Surface& surface_;
};

}  // namespace spherical_springs::mesh
