#include <malloc.h>
#include <ros/ros.h>

#include <algorithm>
#include <array>
#include <clocale>
#include <csignal>
#include <stdexcept>
#include <string>

#include "base/files.h"
#include "node/actions.h"
#include "node/callback_threads.h"
#include "node/faults.h"
#include "node/handlers.h"
#include "node/map_handler.h"
#include "node/map_turn.h"
#include "node/marker_publisher.h"
#include "node/news.h"
#include "node/parameters.h"
#include "node/publisher.h"
#include "node/reconfiguration.h"
#include "node/request_memory.h"
#include "node/scene_directory.h"
#include "node/services.h"
#include "node/stepper.h"
#include "simulation/runner.h"
#include "spherical_springs/measures.h"
#include "spherical_springs/range.h"
#include "spherical_springs/scene_file.h"

namespace spherical_springs {
namespace {

void loadFirstScene(const Parameters& parameters, const SceneDirectory& directory,
                    core::Runner& runner) {
  if (parameters.scene.empty()) return;
  try {
    auto file = core::readScene(directory.path() / core::homeExpanded(parameters.scene),
                                parameters.simulation().limits);
    runner.change([&](core::Simulation& s) { s.load(std::move(file)); });
  } catch (const std::exception& fault) {
    throw std::invalid_argument("parameter ~scene is " + core::quoted(parameters.scene) +
                                "; allowed: a scene file; " + reasonOf(fault));
  }
}

/// Says in the log what runs, as a person who has just started it would ask.
void tellOfStart(const Parameters& parameters, const SceneDirectory& directory,
                 core::Runner& runner) {
  const core::StepChoice steps = runner.choice();
  const core::Runner::Snapshot now = runner.snapshot();
  const core::System& system = *now.plan->system();
  const std::size_t springs =
      runner.read([](const core::Simulation& s) { return s.scene().springCount(); });
  const double stable = std::min(core::StepWish::kLongest,
                                 core::stableTimeStep(system, steps.method, now.state.positions));
  const std::string scene = parameters.scene.empty() ? "none" : core::quoted(parameters.scene);
  ROS_INFO(
      "%s: %zu particles, %zu springs; %s, time step %s s (stable up to %.3g s); %d thread%s; "
      "scene %s; files in %s",
      now.running ? "running" : "paused", static_cast<std::size_t>(system.particleCount()), springs,
      core::nameOf(steps.method), core::toText(steps.time_step).c_str(), stable,
      parameters.simulation().system.threads,
      parameters.simulation().system.threads == 1 ? "" : "s", scene.c_str(),
      core::onOneLine(directory.path()).c_str());
}

// Who runs what, beside the threads of ROS itself, which read requests and send what is published:
//   calls       eight threads, one for each service call or goal under way, long ones too
//   cancelling, pausing   ~cancel and ~set_running, which long calls must not hold up
//   receiving   goals of actions, which it hands to calls, and their cancels
//   ticking     the clock's ticks, which it hands to the thread of Stepper, which steps
//   sampling    ~poses and ~energies
//   reporting   ~status and /diagnostics
//   reconfiguring   dynamic_reconfigure, which waits for the master
//   drawing     ~markers
// A relaxation has a thread of its own, for which the caller waits (Runner); loops over many
// springs are shared among threads of the core.
struct Threads {
  CallbackThreads calls{8}, cancelling{1}, pausing{1}, receiving{1}, ticking{1}, sampling{1},
      reporting{1}, drawing{1}, reconfiguring{1};

  void start() {
    for (CallbackThreads* threads : all()) threads->start();
  }
  void stop() {
    for (CallbackThreads* threads : all()) threads->stop();
  }

 private:
  std::array<CallbackThreads*, 9> all() {
    return {&calls,    &cancelling, &pausing, &receiving,    &ticking,
            &sampling, &reporting,  &drawing, &reconfiguring};
  }
};

void run() {
  const ros::NodeHandle node("~");
  const Parameters parameters = Parameters::from(node);
  const SceneDirectory directory(parameters.scene_directory);
  const core::SceneLimits limits = parameters.simulation().limits;
  core::Runner runner(parameters.simulation(), parameters.running);
  loadFirstScene(parameters, directory, runner);

  const RequestMemory request_memory;
  Threads threads;
  News news;
  MapTurn mappings;
  Handlers handlers(runner, news, mappings, directory, limits, parameters.frame_id);
  MapHandler mapper(runner, news, mappings, limits, parameters.simulation().system.threads);
  Publisher publisher(threads.sampling.handle(node), threads.reporting.handle(node), runner, news,
                      parameters);
  MarkerPublisher markers(threads.drawing.handle(node), runner, parameters);
  const Services services(threads.calls.handle(node), threads.cancelling.handle(node),
                          threads.pausing.handle(node), handlers, news, limits);
  const Actions actions(threads.receiving.handle(node), threads.calls.queue(), handlers, mapper,
                        news);
  Stepper stepper(threads.ticking.handle(node), runner, parameters);
  const Reconfiguration reconfiguration(threads.reconfiguring.handle(node), runner, news, stepper,
                                        publisher, markers, parameters);
  threads.start();
  tellOfStart(parameters, directory, runner);
  ros::waitForShutdown();
  mappings.close();
  runner.close();
  threads.stop();
}

}  // namespace
}  // namespace spherical_springs

int main(int argc, char** argv) {
  // The log writes names of files in the encoding of the locale, which a service or a container may
  // not set. Numbers keep their points.
  std::setlocale(LC_CTYPE, "C.UTF-8");  // NOLINT(concurrency-mt-unsafe): no other thread yet
  ros::init(argc, argv, "spherical_springs");
#ifdef M_ARENA_MAX
  // Each thread that calls come in on would keep the memory of the largest for itself.
  mallopt(M_ARENA_MAX, 1);  // NOLINT(concurrency-mt-unsafe): there is no other thread yet
#endif
  const ros::NodeHandle keeps_the_log_alive;  // the last handle to go closes it
  std::signal(SIGXFSZ, SIG_IGN);  // a file that grows too long is one that cannot be written
  // ROS itself sees to SIGINT alone; SIGTERM would end a save in the middle. The first handle
  // starts ROS and thereby forgets every earlier request to shut down, so this comes after it.
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
