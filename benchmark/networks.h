// Scenes to relax, the same every run.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "spherical_springs/scene.h"

namespace benchmark_scenes {

using spherical_springs::core::Scene;

/// An icosphere of 10 * 4^level + 2 vertices: an angle spring on each edge (stiffness 1, at rest
/// within 10 % of its arc), a solid-angle spring on each face (stiffness 10, at rest within 20 % of
/// its area), and every particle displaced by a Gaussian of 0.15 mean edges in its tangent plane.
Scene benchmarkScene(int level);

struct Network {
  std::string name;
  std::function<Scene()> make;
};

/// Networks of every sort, most of some hundred to some thousand particles.
std::vector<Network> networks();

}  // namespace benchmark_scenes
