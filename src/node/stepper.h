#pragma once

#include <ros/node_handle.h>
#include <ros/timer.h>

#include <condition_variable>
#include <mutex>
#include <thread>

#include "pacer.h"
#include "parameters.h"
#include "spherical_springs/runner.h"

namespace spherical_springs {

/// Lets the simulation's time go with the clock of ROS, and so with /clock under use_sim_time. It
/// steps on a thread of its own, so that the threads that answer have the processor when they ask.
class Stepper {
 public:
  /// `runner` must live longer.
  Stepper(const ros::NodeHandle& node, core::Runner& runner, const Parameters& parameters);
  ~Stepper();

 private:
  void tick();
  void stepAtEachTick();
  void step();

  core::Runner& runner_;  // safe for many threads by itself

  // Used by the thread alone.
  Pacer pacer_;
  ros::Time last_step_;
  ros::WallTime last_wall_step_;

  std::mutex mutex_;  // guards what follows
  std::condition_variable changed_;
  bool ticked_ = false, ends_ = false;

  std::thread thread_;
  ros::Timer timer_;  // last, so that its callbacks end before what they use
};

}  // namespace spherical_springs
