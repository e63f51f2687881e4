// Scene files of any bytes: refused, or scenes that are written and read back the same and can
// step.
#include <cstdint>
#include <sstream>
#include <stdexcept>
#include <string>

#include "soundness.h"
#include "spherical_springs/scene_file.h"

using namespace spherical_springs::core;

namespace {

std::string textOf(const SceneFile& file) {
  std::ostringstream text;
  writeScene(text, file.scene, file.time);
  return text.str();
}

SceneFile sceneOf(const std::string& text) {
  SceneLimits limits;
  limits.particles = limits.springs = 1000;
  std::istringstream in(text);
  return readScene(in, limits);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  SceneFile file;
  try {
    file = sceneOf(std::string(data, data + size));
  } catch (const std::invalid_argument&) {
    return 0;
  }
  const std::string written = textOf(file);
  fuzzing::require(textOf(sceneOf(written)) == written, "a scene reads back to the last bit");

  Simulation simulation({});
  simulation.load(std::move(file));
  simulation.step();
  fuzzing::requireSound(simulation);
  return 0;
}
