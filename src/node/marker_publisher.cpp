#include "marker_publisher.h"

#include <ros/serialization.h>
#include <ros/single_subscriber_publisher.h>

#include <algorithm>
#include <utility>

#include "markers.h"

namespace spherical_springs {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

namespace {

/// All that may change, in an order of their own.
std::vector<Marker> changingMarkers(const core::Runner::Snapshot& now, double radius) {
  const core::System& system = *now.system;
  const core::Points& positions = now.state.positions;
  return {particlesMarker(system, positions, radius), arcsMarker(system, positions, radius),
          trianglesMarker(system, positions, radius)};
}

bool samePlaces(const core::Points& a, const core::Points& b) {
  return a.cols() == b.cols() && a == b;
}

}  // namespace

MarkerPublisher::MarkerPublisher(ros::NodeHandle node, core::Runner& runner,
                                 const Parameters& parameters)
    : parameters_(parameters), runner_(runner) {
  // Not too few: what a listener loses of springs that stand still does not come again.
  constexpr int kQueue = 10;
  publisher_ = node.advertise<MarkerArray>(
      "markers", kQueue,
      [this](const ros::SingleSubscriberPublisher& listener) { greet(listener); });
  timer_ = node.createTimer(ros::Duration(1 / parameters_.publish_rate),
                            [this](const ros::TimerEvent&) { publishChanges(); });
}

void MarkerPublisher::greet(const ros::SingleSubscriberPublisher& listener) {
  const std::lock_guard<std::mutex> lock(mutex_);
  auto now = runner_.snapshot();
  std::vector<Marker> markers = changingMarkers(now, parameters_.radius);
  if (publisher_.getNumSubscribers() <= 1) remember(std::move(now), markers);
  listener.publish(arrayOf(std::move(markers)));
}

void MarkerPublisher::publishChanges() {
  // What large scenes may take of everyone's time: of the network's, and of a processor's.
  constexpr double kBytesPerSecond = 5e7;
  constexpr double kRestAfterWork = 4;
  if (publisher_.getNumSubscribers() == 0) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  if (sent_.empty() || ros::WallTime::now() < next_) return;
  const ros::WallTime begin = ros::WallTime::now();
  auto now = runner_.snapshot();
  if (now.system == system_ && samePlaces(now.state.positions, positions_)) return;

  std::vector<Marker> markers = changingMarkers(now, parameters_.radius);
  std::vector<Marker> changed;
  for (std::size_t i = 0; i < markers.size(); ++i) {
    if (markers[i] != sent_[i]) changed.push_back(markers[i]);
  }
  remember(std::move(now), std::move(markers));
  if (changed.empty()) return;

  const MarkerArray message = arrayOf(std::move(changed));
  const double bytes = ros::serialization::serializationLength(message);
  publisher_.publish(message);
  const ros::WallTime end = ros::WallTime::now();
  next_ =
      end + std::max(ros::WallDuration(bytes / kBytesPerSecond), (end - begin) * kRestAfterWork);
}

void MarkerPublisher::remember(core::Runner::Snapshot moment, std::vector<Marker> markers) {
  system_ = std::move(moment.system);
  positions_ = std::move(moment.state.positions);
  sent_ = std::move(markers);
}

MarkerArray MarkerPublisher::arrayOf(std::vector<Marker> markers) {
  MarkerArray message;
  message.markers = std::move(markers);
  message.markers.push_back(sphereMarker(parameters_.radius));
  for (Marker& marker : message.markers) {
    marker.header.frame_id = parameters_.frame_id;
    marker.header.stamp = ros::Time::now();
  }
  return message;
}

}  // namespace spherical_springs
