// The task that a command line asks for, read and checked.
#pragma once

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "relax_mesh/options.h"
#include "spherical_springs/maps/triangle_mesh.h"
#include "spherical_springs/range.h"

namespace spherical_springs::relax_mesh {

using core::Points;
using core::Values;

struct Task {
  mesh::TriangleMesh surface;
  std::vector<std::string> repairs;   ///< a sentence each
  Values density;                     ///< one a face; empty: all alike
  Values shares;                      ///< of the sphere, one a face, summing to 4 pi [sr]
  std::filesystem::path shares_from;  ///< the file that has the last word on them
  std::optional<Points> start;        ///< one unit vector a vertex
  bool inside_out = false;            ///< whether the surface's faces look inwards
};

/// Puts the file's name before the reason why what it holds is refused.
template <class Use>
auto about(const std::filesystem::path& path, const Use& use) {
  try {
    return use();
  } catch (const std::invalid_argument& fault) {
    throw std::invalid_argument(core::onOneLine(path) + ": " + fault.what());
  }
}

/// Reads what the options name. Densities are one a face of the file, in its order.
/// @throw std::invalid_argument or std::runtime_error, with the file and the reason, for a surface
/// that, after the repairs asked for, is no topological sphere or has no area, for densities that
/// are not one a face, and for a start that has other faces than the surface or a vertex without
/// direction.
Task readTask(const Options& options);

/// The wall time for the map [s], asked for or by the size of the mesh.
double timeFor(const Task& task, const Options& options);

}  // namespace spherical_springs::relax_mesh
