#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/timer.h>
#include <visualization_msgs/MarkerArray.h>

#include <array>
#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

#include "node/parameters.h"
#include "node/rest.h"
#include "simulation/runner.h"

namespace spherical_springs {

/// Publishes ~markers: all to a new listener at once, and afterwards, at the publishing rate at
/// most, those that have changed. What could not be sent, for want of memory, is sent later.
class MarkerPublisher {
 public:
  /// `runner` must live longer.
  MarkerPublisher(ros::NodeHandle node, core::Runner& runner, const Parameters& parameters);

  /// Begins a new period; for one thread at a time. `rate`: [Hz].
  void setRate(double rate);

 private:
  /// All that may change, in an order of their own.
  using Markers = std::array<visualization_msgs::Marker, 3>;

  Markers markersOf(const core::Runner::Snapshot& moment) const;
  void greet(const ros::SingleSubscriberPublisher& listener);
  void sendAll(const ros::SingleSubscriberPublisher& listener);
  void publishChanges();
  void remember(core::Runner::Snapshot&& moment, Markers&& markers) noexcept;
  void forget(std::size_t marker) noexcept;
  /// Adds the sphere, which is small, and headers.
  visualization_msgs::MarkerArray arrayOf(std::vector<visualization_msgs::Marker> markers) const;

  // Read-only.
  const Parameters parameters_;

  core::Runner& runner_;  // safe for many threads by itself

  // So that no listener gets an older moment after a newer one. Guards what follows.
  std::mutex mutex_;
  bool greeted_ = false;  // anyone
  Markers sent_;          // the last ones that went to all; empty where some have not got the last
  // The moment that they show; no plan where some have not got the last.
  std::shared_ptr<const core::Plan> plan_;
  core::Points positions_;
  Rest rest_;

  // Last, so that their callbacks end before what these use.
  ros::Publisher publisher_;
  ros::Timer timer_;
};

}  // namespace spherical_springs
