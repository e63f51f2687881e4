#pragma once

#include <ros/node_handle.h>
#include <ros/service_server.h>

#include <deque>
#include <string>
#include <vector>

#include "node/handlers.h"
#include "node/news.h"
#include "node/refusals.h"

namespace spherical_springs {

/// The services of the node.
class Services {
 public:
  /// Advertises all services: ~cancel and ~set_running under handles of their own, whose queues are
  /// to be called while long calls occupy the threads of the others. What is passed must live
  /// longer.
  Services(ros::NodeHandle node, ros::NodeHandle cancelling, ros::NodeHandle pausing,
           Handlers& handlers, News& news, const core::SceneLimits& limits);

 private:
  template <class Service>
  using Handler = void (Handlers::*)(const typename Service::Request&, Answer<Service>&);

  template <class Service>
  void advertiseReader(ros::NodeHandle& node, const std::string& name, Handler<Service> handle);

  /// A service after whose calls, refused ones too, the status is published, and samples after
  /// those that succeed.
  template <class Service>
  void advertise(ros::NodeHandle& node, const std::string& name, Handler<Service> handle);

  template <class Service, class Handle>
  void advertiseAny(ros::NodeHandle& node, const std::string& name, const Handle& handle);

  Handlers& handlers_;
  News& news_;
  const core::SceneLimits limits_;
  std::deque<Refusals> refusals_;  // one a service, which refers to it
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace spherical_springs
