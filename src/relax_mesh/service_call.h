// Calls of services that end, whatever the other side does.
#pragma once

#include <ros/node_handle.h>
#include <ros/service_client.h>

#include <functional>
#include <stdexcept>
#include <string>

namespace spherical_springs::relax_mesh {

/// A service that is not there, breaks the connection, or does not answer in time.
struct NoAnswer : std::runtime_error {
  explicit NoAnswer(const std::string& service)
      : std::runtime_error(service + " does not answer") {}
};

struct Patience {
  double seconds = 10;  ///< for the answer; after an interruption one second at most
  std::function<void()> on_interruption = [] {};  ///< called again and again after one
};

/// Returns what `call` returns, which runs on a thread of its own; when there is no more patience,
/// `hang_up` is to end it.
bool waitFor(const std::function<bool()>& call, const std::function<void()>& hang_up,
             const Patience& patience);

/// Calls a service over a connection of its own that stays until the answer has come: where the
/// server hangs up after the answer, roscpp may lose the answer (ros_comm, issue 1976).
/// @throw NoAnswer; std::runtime_error with the reason where the service refuses.
template <class Service>
typename Service::Response callService(const std::string& name,
                                       const typename Service::Request& request,
                                       const Patience& patience = {}) {
  constexpr bool kPersistent = true;
  ros::ServiceClient client = ros::NodeHandle().serviceClient<Service>(name, kPersistent);
  typename Service::Response response;
  const auto call = [&] {
    return client.isValid() &&
           client.call(request, response, ros::service_traits::md5sum<Service>());
  };
  if (!waitFor(
          call, [&] { client.shutdown(); }, patience))
    throw NoAnswer(name);
  if (!response.success) throw std::runtime_error(name + ": " + response.message);
  return response;
}

}  // namespace spherical_springs::relax_mesh
