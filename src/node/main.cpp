#include <malloc.h>
#include <ros/ros.h>

#include <csignal>
#include <stdexcept>

#include "marker_publisher.h"
#include "parameters.h"
#include "publisher.h"
#include "scene_directory.h"
#include "services.h"
#include "spherical_springs/range.h"
#include "spherical_springs/runner.h"
#include "spherical_springs/scene_file.h"
#include "stepper.h"

namespace spherical_springs {
namespace {

void loadFirstScene(const Parameters& parameters, const SceneDirectory& directory,
                    core::Runner& runner) {
  if (parameters.scene.empty()) return;
  try {
    auto file =
        core::readScene(directory.path() / parameters.scene, parameters.simulation().limits);
    runner.change([&](core::Simulation& s) { s.load(std::move(file)); });
  } catch (const std::exception& fault) {
    throw std::invalid_argument("parameter ~scene is " + core::quoted(parameters.scene) +
                                "; allowed: a scene file; " + fault.what());
  }
}

void run() {
  constexpr int kThreads = 8;  // long calls hold one each
  ros::NodeHandle node("~");
  const Parameters parameters = Parameters::from(node);
  const SceneDirectory directory(parameters.scene_directory);
  core::Runner runner(parameters.simulation(), parameters.running);
  loadFirstScene(parameters, directory, runner);

  Publisher publisher(node, runner, parameters);
  const MarkerPublisher markers(node, runner, parameters);
  const Services services(node, runner, publisher, directory);
  const Stepper stepper(node, runner, parameters);
  ros::AsyncSpinner spinner(kThreads);
  spinner.start();
  ros::waitForShutdown();
  runner.close();
  spinner.stop();
}

}  // namespace
}  // namespace spherical_springs

int main(int argc, char** argv) {
  ros::init(argc, argv, "spherical_springs");
#ifdef M_ARENA_MAX
  // Each thread that calls come in on would keep the memory of the largest for itself.
  mallopt(M_ARENA_MAX, 1);  // NOLINT(concurrency-mt-unsafe): there is no other thread yet
#endif
  const ros::NodeHandle keeps_the_log_alive;  // the last handle to go closes it
  // ROS itself sees to SIGINT alone; SIGTERM would end a save in the middle. The first handle starts
  // ROS and thereby forgets every earlier request to shut down, so this comes after it.
  std::signal(SIGTERM, [](int) { ros::requestShutdown(); });
  try {
    spherical_springs::run();
  } catch (const std::exception& fault) {
    // Told to end while it starts, it gets no parameters from ROS any more.
    if (ros::isShuttingDown()) return 0;
    ROS_FATAL("%s", fault.what());
    return 1;
  }
  return 0;
}
