#pragma once

#include <ros/node_handle.h>
#include <ros/timer.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "node/parameters.h"
#include "node/step_clock.h"
#include "simulation/runner.h"

namespace spherical_springs {

/// Lets the simulation's time go with the clock of ROS, and so with /clock under use_sim_time. It
/// steps on a thread of its own, so that the threads that answer have the processor when they ask.
class Stepper {
 public:
  /// The callbacks of `node` tell of the clock's ticks, and take no time. `runner` must live
  /// longer.
  Stepper(const ros::NodeHandle& node, core::Runner& runner, const Parameters& parameters);
  ~Stepper();

  /// Goes on with another time step and factor. For any thread.
  void setPace(const Pace& pace);

 private:
  void tick();
  void stepAtEachTick();
  void step();

  /// @return the simulated time that is due after `elapsed` [s].
  double dueAfter(double elapsed);

  core::Runner& runner_;  // safe for many threads by itself

  // Used by the thread alone.
  ros::Time last_step_;
  std::chrono::steady_clock::time_point last_wall_step_;

  std::mutex mutex_;  // guards what follows
  std::condition_variable changed_;
  StepClock step_clock_;
  bool ticked_ = false, ends_ = false;

  ros::Timer timer_;
  std::thread thread_;  // last, so that nothing can fail once it has begun
};

}  // namespace spherical_springs
