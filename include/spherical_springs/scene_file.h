// Scene files: JSON (which is YAML too), with the fields of the ROS messages.
#pragma once

#include <filesystem>
#include <istream>
#include <ostream>

#include "spherical_springs/scene.h"

namespace spherical_springs::core {

/// A scene and the moment that it was saved at.
/// \snippet test_headers.cpp scene_file
struct SceneFile {
  Scene scene;      ///< with particles where they were when it was saved
  double time = 0;  ///< simulated [s]
};

/// Fields left out are zero, ids left out follow the last one. A file with more than `limits` allow
/// is refused at the first item too many.
/// @throw std::runtime_error when the file cannot be read, std::invalid_argument when what it says
/// is not a scene: with the byte in the file where it is no JSON, or item, field, value and what is
/// allowed.
SceneFile readScene(const std::filesystem::path& path, SceneLimits limits);

/// Reads a scene from a stream that can tell its position.
SceneFile readScene(std::istream& in, SceneLimits limits);

/// Writes beside `path` and renames, so that `path` is whole at any moment, whoever else writes it;
/// links are followed. Reading the file gives the same scene to the last bit. A process that is
/// killed meanwhile leaves a file spherical_springs.part* behind in the same directory.
/// @throw std::runtime_error when it cannot be written.
void writeScene(const std::filesystem::path& path, const Scene& scene, double time);

/// Writes a scene to a stream, whose state tells whether it succeeded.
void writeScene(std::ostream& out, const Scene& scene, double time);

}  // namespace spherical_springs::core
