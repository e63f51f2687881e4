#include "node/marker_publisher.h"

#include <ros/serialization.h>
#include <ros/single_subscriber_publisher.h>

#include <algorithm>
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
    : parameters_(parameters), runner_(runner), period_(1 / parameters.publish_rate) {
  constexpr int kQueue = 10;  // not too few: what a listener loses comes again some seconds later
  const ros::WallDuration kCheck(0.05);
  publisher_ = node.advertise<MarkerArray>(
      "markers", kQueue, [this](const ros::SingleSubscriberPublisher&) { greet(); });
  timer_ = node.createTimer(ros::Duration(period_),
                            loggingFaults("~markers are sent later", [this] { publishChanges(); }));
  overdue_timer_ = node.createSteadyTimer(
      kCheck, loggingFaults("~markers come later", [this] { publishWhatIsOverdue(); }));
}

void MarkerPublisher::setRate(double rate) {
  period_ = 1 / rate;
  timer_.setPeriod(ros::Duration(1 / rate));
}

MarkerPublisher::Markers MarkerPublisher::markersOf(const core::Runner::Snapshot& moment) const {
  const core::System& system = *moment.plan->system();
  const core::Points& positions = moment.state.positions;
  const double radius = parameters_.radius;
  return {particlesMarker(system, positions, radius), arcsMarker(system, positions, radius),
          trianglesMarker(system, positions, radius)};
}

void MarkerPublisher::greet() {
  const std::lock_guard<std::mutex> lock(mutex_);
  greeted_ = true;
  if (runLoggingFaults("a new listener gets ~markers later", [this] { sendAll(); })) return;
  sent_all_ = {};
}

void MarkerPublisher::sendAll() {
  auto now = runner_.snapshot();
  Markers markers = markersOf(now);
  publisher_.publish(arrayOf({markers.begin(), markers.end()}));
  sent_all_ = Clock::now();
  remember(std::move(now), std::move(markers));
}

void MarkerPublisher::publishChanges() {
  if (publisher_.getNumSubscribers() == 0) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  last_look_ = Clock::now();
  if (!greeted_ || !rest_.isOver()) return;
  Rest::Work work(rest_);
  auto now = runner_.snapshot();
  const bool all = areAllDue();
  if (!all && now.plan == plan_ && samePlaces(now.state.positions, positions_)) return;

  Markers markers = markersOf(now);
  std::vector<Marker> wanted;
  for (std::size_t i = 0; i < markers.size(); ++i) {
    if (all || markers[i] != sent_[i]) wanted.push_back(markers[i]);
  }
  if (!wanted.empty()) publish(std::move(wanted), work);
  if (all) sent_all_ = Clock::now();
  remember(std::move(now), std::move(markers));
}

bool MarkerPublisher::areAllDue() const {
  constexpr std::chrono::seconds kAgain(4);
  return Clock::now() - sent_all_ >= kAgain;
}

/// Publishes changes where the clock of ROS stands, and all markers where its ticks are too rare.
void MarkerPublisher::publishWhatIsOverdue() {
  constexpr double kShortest = 0.2;  // [s]
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const std::chrono::duration<double> since_last = Clock::now() - last_look_;
    if (since_last.count() < std::max<double>(period_, kShortest) && !areAllDue()) return;
  }
  publishChanges();
}

void MarkerPublisher::publish(std::vector<Marker> markers, Rest::Work& work) const {
  constexpr double kBytesPerSecond = 5e7;  // of the network
  const MarkerArray message = arrayOf(std::move(markers));
  publisher_.publish(message);
  work.restAtLeast(ros::serialization::serializationLength(message) / kBytesPerSecond);
}

void MarkerPublisher::remember(core::Runner::Snapshot&& moment, Markers&& markers) noexcept {
  plan_ = std::move(moment.plan);
  positions_ = std::move(moment.state.positions);
  sent_ = std::move(markers);
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
