#pragma once

#include <ros/node_handle.h>
#include <ros/service_server.h>

#include <exception>
#include <functional>
#include <new>
#include <string>
#include <utility>

#include "node/answer.h"
#include "node/faults.h"
#include "node/refusals.h"
#include "node/request_stream.h"

namespace spherical_springs {

/// A service that answers whatever happens: what goes wrong, from reading the request to writing
/// the response, becomes `success: false` and a message beside an otherwise empty response. (ROS's
/// own takes memory for whatever lengths a request claims.)
template <class Service>
class AnsweringService : public ros::ServiceCallbackHelper {
 public:
  /// Fills the response or throws.
  using Handle = std::function<void(const typename Service::Request&, Answer<Service>&)>;

  /// A request that breaks `limits` does not come to `handle`. `refusals` must live longer.
  AnsweringService(const core::SceneLimits& limits, Handle handle, Refusals& refusals)
      : limits_(limits),
        handle_(std::move(handle)),
        refusals_(refusals),
        out_of_memory_(refusalThatMayFail(reasonOf(std::bad_alloc()))) {}

  bool call(ros::ServiceCallbackHelperCallParams& params) override {
    try {
      params.response = answer(params.request);
    } catch (const std::exception& fault) {
      params.response = refusal(reasonOf(fault));
      refusals_.tell(fault);
    } catch (...) {
      params.response = refusal("the reason is unknown");
    }
    return true;
  }

 private:
  ros::SerializedMessage answer(const ros::SerializedMessage& bytes) const {
    const auto request = readRequest<typename Service::Request>(bytes, limits_);
    Answer<Service> answer;
    handle_(request, answer);
    return answer.serialized(true);
  }

  ros::SerializedMessage refusal(const char* reason) const noexcept {
    try {
      return refusalThatMayFail(reason);
    } catch (...) {
      return out_of_memory_;
    }
  }

  static ros::SerializedMessage refusalThatMayFail(const char* reason) {
    Answer<Service> answer;
    answer.response.message = reason;
    return answer.serialized(false);
  }

  const core::SceneLimits limits_;
  const Handle handle_;
  Refusals& refusals_;
  const ros::SerializedMessage out_of_memory_;  // made while there is memory
};

/// Advertises an AnsweringService.
template <class Service>
ros::ServiceServer advertiseAnswering(ros::NodeHandle& node, const std::string& name,
                                      const core::SceneLimits& limits,
                                      typename AnsweringService<Service>::Handle handle,
                                      Refusals& refusals) {
  ros::AdvertiseServiceOptions options;
  options.init<Service>(name, {});
  options.helper =
      boost::make_shared<AnsweringService<Service>>(limits, std::move(handle), refusals);
  return node.advertiseService(options);
}

}  // namespace spherical_springs
