// Names of the parts of a mesh, for messages about it.
#pragma once

#include <cstdint>
#include <string>

namespace spherical_springs::mesh {

/// Faults that a reader of files may know a remedy for.
enum class MeshFault { open, several_pieces, unused_vertex, repeated_vertex };

/// Names parts of a mesh by its own indices, from 0. Readers of files name them as the file does.
struct MeshNames {
  virtual ~MeshNames() = default;

  virtual std::string vertex(std::int32_t index) const { return "vertex " + std::to_string(index); }
  virtual std::string face(std::int32_t index) const { return "face " + std::to_string(index); }
  virtual std::string edge(std::int32_t from, std::int32_t to) const {
    return "edge " + std::to_string(from) + "-" + std::to_string(to);
  }

  /// Returns what a person can do against a fault, with a separator before it, or nothing.
  /// @param size the number of edges of the longest hole where the mesh is open
  virtual std::string remedy(MeshFault /*fault*/, std::int32_t /*size*/) const { return ""; }
};

}  // namespace spherical_springs::mesh
