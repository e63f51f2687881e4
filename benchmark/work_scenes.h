// Scenes on which speed is measured against error.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "spherical_springs/scene.h"
#include "spherical_springs/sphere.h"

namespace benchmark_scenes {

/// A scene, and for how long it is stepped.
struct WorkScene {
  std::string name;
  spherical_springs::core::Scene scene;
  double duration;  ///< [s]
  /// Positions at a time [s] in closed form; null where there is none.
  std::function<spherical_springs::core::Points(double)> solution;
};

/// Returns the scenes, always the same.
std::vector<WorkScene> workScenes();

/// Returns a mesh of 642 particles, 1,920 arcs with this damping [J s/rad^2] and 1,280 triangles,
/// a little out of shape.
spherical_springs::core::Scene mesh(double damping);

}  // namespace benchmark_scenes
