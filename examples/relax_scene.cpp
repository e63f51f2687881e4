// Reads a scene file, relaxes it, and prints the outcome and where the particles are then. It needs
// the library alone, no ROS; the CMakeLists.txt beside it builds it.
#include <spherical_springs/relaxation.h>
#include <spherical_springs/scene_file.h>

#include <exception>
#include <iostream>

using namespace spherical_springs::core;

int main(int argc, char** argv) try {
  if (argc != 2) {
    std::cerr << "usage: relax_scene SCENE.json\n";
    return 2;
  }
  const Scene scene = readScene(argv[1], SceneLimits()).scene;
  const IdTable<Particle>& particles = scene.particles();
  Points positions(3, particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i) {
    positions.col(i) = particles.item(i).position;
  }

  const System system(scene, System::Options());
  const RelaxationResult result = relax(system, positions, RelaxationOptions());

  std::cout << (result.converged ? "converged" : "not converged: " + result.message) << "\n"
            << "potential energy: " << result.energy_before << " J before, " << result.energy_after
            << " J after\n";
  for (std::size_t i = 0; i < particles.size(); ++i) {
    std::cout << "particle " << particles.ids()[i] << ": " << result.positions.col(i).transpose()
              << "\n";
  }
  return result.converged ? 0 : 1;
} catch (const std::exception& fault) {
  std::cerr << "relax_scene: " << fault.what() << "\n";
  return 1;
}
