#include "node/marker_publisher.h"

#include <ros/serialization.h>
#include <ros/single_subscriber_publisher.h>

#include <utility>

#include "node/faults.h"
#include "node/markers.h"

namespace spherical_springs {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

namespace {

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
                            loggingFaults("~markers are sent later", [this] { publishChanges(); }));
}

void MarkerPublisher::setRate(double rate) { timer_.setPeriod(ros::Duration(1 / rate)); }

MarkerPublisher::Markers MarkerPublisher::markersOf(const core::Runner::Snapshot& moment) const {
  const core::System& system = *moment.plan->system();
  const core::Points& positions = moment.state.positions;
  const double radius = parameters_.radius;
  return {particlesMarker(system, positions, radius), arcsMarker(system, positions, radius),
          trianglesMarker(system, positions, radius)};
}

void MarkerPublisher::greet(const ros::SingleSubscriberPublisher& listener) {
  const std::lock_guard<std::mutex> lock(mutex_);
  greeted_ = true;
  if (runLoggingFaults("a new listener gets ~markers later", [&] { sendAll(listener); })) return;
  for (std::size_t i = 0; i < sent_.size(); ++i) forget(i);
}

void MarkerPublisher::sendAll(const ros::SingleSubscriberPublisher& listener) {
  auto now = runner_.snapshot();
  Markers markers = markersOf(now);
  listener.publish(arrayOf({markers.begin(), markers.end()}));
  if (publisher_.getNumSubscribers() <= 1) {
    remember(std::move(now), std::move(markers));
    return;
  }
  // The others have older ones.
  for (std::size_t i = 0; i < sent_.size(); ++i) {
    if (markers[i] != sent_[i]) forget(i);
  }
}

void MarkerPublisher::publishChanges() {
  constexpr double kBytesPerSecond = 5e7;  // of the network
  if (publisher_.getNumSubscribers() == 0) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!greeted_ || !rest_.isOver()) return;
  Rest::Work work(rest_);
  auto now = runner_.snapshot();
  if (now.plan == plan_ && samePlaces(now.state.positions, positions_)) return;

  Markers markers = markersOf(now);
  std::vector<Marker> changed;
  for (std::size_t i = 0; i < markers.size(); ++i) {
    if (markers[i] != sent_[i]) changed.push_back(markers[i]);
  }
  if (!changed.empty()) {
    const MarkerArray message = arrayOf(std::move(changed));
    publisher_.publish(message);
    work.restAtLeast(ros::serialization::serializationLength(message) / kBytesPerSecond);
  }
  remember(std::move(now), std::move(markers));
}

void MarkerPublisher::remember(core::Runner::Snapshot&& moment, Markers&& markers) noexcept {
  plan_ = std::move(moment.plan);
  positions_ = std::move(moment.state.positions);
  sent_ = std::move(markers);
}

void MarkerPublisher::forget(std::size_t marker) noexcept {
  sent_[marker] = Marker();
  plan_.reset();
}

MarkerArray MarkerPublisher::arrayOf(std::vector<Marker> markers) const {
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
