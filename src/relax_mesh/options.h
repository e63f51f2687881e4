// The command line of relax_mesh.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "surfaces/placement.h"
#include "surfaces/projection.h"
#include "surfaces/repairs.h"

namespace spherical_springs::relax_mesh {

struct Options {
  std::filesystem::path mesh, output;
  std::filesystem::path sphere, uv, density, metrics;  ///< empty where not asked for
  mesh::Repairs repairs;
  mesh::Placement placement;
  mesh::Projection projection = mesh::Projection::longitude_latitude;
  double spread = 1e-3;            ///< wanted
  std::optional<double> max_time;  ///< wall [s]; nothing: by the size of the mesh
  double angle_weight = 0;
  std::string node;   ///< empty where this process is to map
  bool load = false;  ///< whether the node is to keep the map as its scene
};

/// Nothing where only help was asked for, which goes to standard output.
/// @throw std::invalid_argument that names the option, its value and what is allowed.
std::optional<Options> parseOptions(const std::vector<std::string>& arguments);

}  // namespace spherical_springs::relax_mesh
