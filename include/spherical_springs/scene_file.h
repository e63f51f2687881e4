// Scene files: JSON (which is YAML too), with the fields of the ROS messages.
#pragma once

#include <filesystem>

#include "spherical_springs/scene.h"

namespace spherical_springs::core {

struct SceneFile {
  Scene scene;
  double time = 0;  ///< simulated [s]
};

/// Fields left out are zero, ids left out follow the last one.
/// @throw std::runtime_error when the file cannot be read, std::invalid_argument when what it says
/// is not a scene: with the place in the file, or item, field, value and what is allowed.
SceneFile readScene(const std::filesystem::path& path, SceneLimits limits);

/// Writes beside `path` and renames, so that `path` is whole at any moment. Reading the file gives
/// the same scene to the last bit.
/// @throw std::runtime_error when it cannot be written.
void writeScene(const std::filesystem::path& path, const Scene& scene, double time);

}  // namespace spherical_springs::core
