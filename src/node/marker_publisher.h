#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/steady_timer.h>
#include <ros/timer.h>
#include <visualization_msgs/MarkerArray.h>

#include <array>
#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <vector>

#include "node/parameters.h"
#include "node/rest.h"
#include "simulation/runner.h"

namespace spherical_springs {

/// Publishes ~markers: all at once when a new listener comes; those that have changed, at the
/// publishing rate at most; and all again every few seconds, for viewers that have lost them. What
/// could not be sent, for want of memory, is sent later.
class MarkerPublisher {
 public:
  /// `runner` must live longer.
  MarkerPublisher(ros::NodeHandle node, core::Runner& runner, const Parameters& parameters);

  /// Begins a new period; for one thread at a time. `rate`: [Hz].
  void setRate(double rate);

 private:
  using Clock = std::chrono::steady_clock;

  /// All that may change, in an order of their own.
  using Markers = std::array<visualization_msgs::Marker, 3>;

  Markers markersOf(const core::Runner::Snapshot& moment) const;
  void greet();
  void sendAll();
  void publishChanges();
  void publishWhatIsOverdue();
  bool areAllDue() const;
  void publish(std::vector<visualization_msgs::Marker> markers, Rest::Work& work) const;
  void remember(core::Runner::Snapshot&& moment, Markers&& markers) noexcept;
  /// Adds the sphere, which is small, and headers.
  visualization_msgs::MarkerArray arrayOf(std::vector<visualization_msgs::Marker> markers) const;

  // Read-only.
  const Parameters parameters_;

  // Safe for many threads by themselves.
  core::Runner& runner_;
  std::atomic<double> period_;  // [s]

  // So that no listener gets an older moment after a newer one. Guards what follows.
  std::mutex mutex_;
  bool greeted_ = false;  // anyone
  Markers sent_;          // the last ones, and the moment that they show
  std::shared_ptr<const core::Plan> plan_;
  core::Points positions_;
  Clock::time_point last_look_, sent_all_;
  Rest rest_;

  // Last, so that their callbacks end before what these use.
  ros::Publisher publisher_;
  ros::Timer timer_;
  ros::SteadyTimer overdue_timer_;
};

}  // namespace spherical_springs
