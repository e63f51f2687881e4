#pragma once

#include <ros/node_handle.h>
#include <ros/timer.h>

#include "pacer.h"
#include "parameters.h"
#include "spherical_springs/runner.h"

namespace spherical_springs {

/// Lets the simulation's time go with the clock of ROS, and so with /clock under use_sim_time.
class Stepper {
 public:
  /// `runner` must live longer.
  Stepper(const ros::NodeHandle& node, core::Runner& runner, const Parameters& parameters);

 private:
  void tick();

  core::Runner& runner_;
  Pacer pacer_;
  ros::Time last_tick_;
  ros::WallTime last_wall_tick_;
  ros::Timer timer_;
};

}  // namespace spherical_springs
