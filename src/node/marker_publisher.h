#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/timer.h>
#include <visualization_msgs/MarkerArray.h>

#include <memory>
#include <mutex>
#include <vector>

#include "parameters.h"
#include "spherical_springs/runner.h"

namespace spherical_springs {

/// Publishes ~markers: all to a new listener at once, and afterwards, at the publishing rate at
/// most, those that have changed.
class MarkerPublisher {
 public:
  /// `runner` must live longer.
  MarkerPublisher(ros::NodeHandle node, core::Runner& runner, const Parameters& parameters);

 private:
  void greet(const ros::SingleSubscriberPublisher& listener);
  void publishChanges();
  void remember(core::Runner::Snapshot moment, std::vector<visualization_msgs::Marker> markers);
  /// With the sphere, which is small, and with headers.
  visualization_msgs::MarkerArray arrayOf(std::vector<visualization_msgs::Marker> markers);

  // Read-only.
  const Parameters parameters_;

  core::Runner& runner_;  // safe for many threads by itself

  // So that no listener gets an older moment after a newer one. Guards what follows.
  std::mutex mutex_;
  // What was last sent to all, and the moment that it shows; empty until someone has listened.
  std::shared_ptr<const core::System> system_;
  core::Points positions_;
  std::vector<visualization_msgs::Marker> sent_;
  ros::WallTime next_;  // not to publish before

  // Last, so that their callbacks end before what these use.
  ros::Publisher publisher_;
  ros::Timer timer_;
};

}  // namespace spherical_springs
