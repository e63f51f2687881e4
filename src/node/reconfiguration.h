#pragma once

#include <dynamic_reconfigure/server.h>
#include <ros/node_handle.h>
#include <ros/wall_timer.h>
#include <spherical_springs/SteppingConfig.h>

#include <boost/thread/recursive_mutex.hpp>

#include "node/marker_publisher.h"
#include "node/news.h"
#include "node/parameters.h"
#include "node/publisher.h"
#include "node/stepper.h"
#include "simulation/runner.h"

namespace spherical_springs {

/// Lets the parameters of Pace change while the node runs, by dynamic_reconfigure: each update as a
/// whole or not at all. The configuration that clients and the parameter server see is what holds.
class Reconfiguration {
 public:
  /// `node`: a handle whose callbacks are called on one thread, as each of them waits for the
  /// master. The others must live longer.
  Reconfiguration(const ros::NodeHandle& node, core::Runner& runner, News& news, Stepper& stepper,
                  Publisher& publisher, MarkerPublisher& markers, const Pace& pace);

 private:
  void reconfigure(SteppingConfig& config) noexcept;
  void change(const SteppingConfig& asked);
  void apply(const Pace& pace);
  void refuse(const std::exception& fault) noexcept;
  void showRunning();

  core::Runner& runner_;
  News& news_;
  Stepper& stepper_;
  Publisher& publisher_;
  MarkerPublisher& markers_;

  // Used by the one thread alone.
  Pace pace_;  // as clients see it; ~set_running may have changed `running` since

  // Last, so that their callbacks end before what these use.
  boost::recursive_mutex
      mutex_;  // of the server, which wants one for updates that it does not make
  dynamic_reconfigure::Server<SteppingConfig> server_;
  ros::WallTimer timer_;
};

}  // namespace spherical_springs
