#pragma once

#include <dynamic_reconfigure/Reconfigure.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/service_server.h>
#include <ros/steady_timer.h>
#include <spherical_springs/SteppingConfig.h>

#include <exception>

#include "node/marker_publisher.h"
#include "node/news.h"
#include "node/parameters.h"
#include "node/publisher.h"
#include "node/stepper.h"
#include "simulation/runner.h"

namespace spherical_springs {

/// Lets the parameters of Pace change while the node runs, by dynamic_reconfigure: each update as a
/// whole or not at all. The configuration that clients and the parameter server see is what holds.
/// (The server of dynamic_reconfigure itself fills in what an update does not name from what it has
/// shown last, and would so undo a ~set_running that it has not heard of.)
class Reconfiguration {
 public:
  /// `node`: a handle whose callbacks are called on one thread, as each of them waits for the
  /// master. The others must live longer.
  Reconfiguration(const ros::NodeHandle& node, core::Runner& runner, News& news, Stepper& stepper,
                  Publisher& publisher, MarkerPublisher& markers, const Pace& pace);

 private:
  using Service = dynamic_reconfigure::Reconfigure;

  bool reconfigure(Service::Request& request, Service::Response& response);
  void change(dynamic_reconfigure::Config& update);
  void apply(const Pace& pace);
  void refuse(const std::exception& fault) noexcept;
  Pace present() const;
  void showChanges();
  void show();

  core::Runner& runner_;
  News& news_;
  Stepper& stepper_;
  Publisher& publisher_;
  MarkerPublisher& markers_;
  ros::NodeHandle node_;

  // Used by the one thread alone.
  // `running`, and a time step that is chosen, as they were shown; they may have changed since.
  Pace pace_;
  bool shown_ = false;

  // Last, so that their callbacks end before what these use.
  ros::Publisher descriptions_, updates_;
  ros::ServiceServer service_;
  ros::SteadyTimer timer_;
};

}  // namespace spherical_springs
