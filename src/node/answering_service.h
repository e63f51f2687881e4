#pragma once

#include <ros/node_handle.h>
#include <ros/service_server.h>

#include <exception>
#include <string>
#include <utility>

#include "request_stream.h"
#include "surviving.h"

namespace spherical_springs {

/// A service that answers whatever happens: what goes wrong, from reading the request to writing
/// the response, becomes `success: false` and a message beside an otherwise empty response. (ROS's
/// own takes memory for whatever lengths a request claims.)
template <class Service, class Handle>
class AnsweringService : public ros::ServiceCallbackHelper {
 public:
  AnsweringService(const core::SceneLimits& limits, Handle handle)
      : limits_(limits), handle_(std::move(handle)) {}

  bool call(ros::ServiceCallbackHelperCallParams& params) override {
    std::string reason;
    try {
      typename Service::Request request;
      typename Service::Response response;
      RequestStream(params.request, limits_).next(request);
      response.success = true;
      handle_(request, response);
      params.response = ros::serialization::serializeServiceResponse(true, response);
      return true;
    } catch (const std::exception& fault) {
      reason = reasonOf(fault);
    }
    typename Service::Response refusal;
    refusal.success = false;
    refusal.message = reason;
    params.response = ros::serialization::serializeServiceResponse(true, refusal);
    return true;
  }

 private:
  const core::SceneLimits limits_;
  const Handle handle_;
};

/// `handle(request, response)` fills the response or throws; a request that breaks `limits` does
/// not come to it.
template <class Service, class Handle>
ros::ServiceServer advertiseAnswering(ros::NodeHandle& node, const std::string& name,
                                      const core::SceneLimits& limits, const Handle& handle) {
  ros::AdvertiseServiceOptions options;
  options.init<Service>(name, {});
  options.helper = boost::make_shared<AnsweringService<Service, Handle>>(limits, handle);
  return node.advertiseService(options);
}

}  // namespace spherical_springs
