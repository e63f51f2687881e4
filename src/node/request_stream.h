#pragma once

#include <ros/serialization.h>
#include <spherical_springs/Particle.h>

#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "spherical_springs/scene.h"

namespace spherical_springs {

/// Reads a request, and refuses arrays before it takes memory for them: those that are longer than
/// the limits of a scene, and those that claim to be longer than the bytes that came.
class RequestStream : public ros::serialization::IStream {
 public:
  RequestStream(const ros::SerializedMessage& message, const core::SceneLimits& limits)
      : IStream(message.message_start,
                message.num_bytes - (message.message_start - message.buf.get())),
        limits_(limits) {}

  /// @throw std::invalid_argument for an array that is too long.
  template <class Item, class Allocator>
  void next(std::vector<Item, Allocator>& items) {
    std::uint32_t count = 0;
    IStream peek(getData(), getLength());
    peek.next(count);
    require<Item>(count, most<Item>(), "");
    require<Item>(count, peek.getLength() / ros::serialization::serializationLength(Item()),
                  ", as many as its bytes can hold");
    ros::serialization::deserialize(*this, items);
  }

  template <class Value>
  void next(Value& value) {
    ros::serialization::deserialize(*this, value);
  }

 private:
  template <class Item>
  std::size_t most() const {
    if constexpr (!ros::message_traits::IsMessage<Item>::value) {
      return std::numeric_limits<std::uint32_t>::max();
    } else {
      return std::is_same_v<Item, Particle> ? limits_.particles : limits_.springs;
    }
  }

  template <class Item>
  static void require(std::size_t count, std::size_t allowed, const char* why) {
    if (count <= allowed) return;
    std::string items = std::is_same_v<Item, std::string> ? "fields" : "ids";
    if constexpr (ros::message_traits::IsMessage<Item>::value) {
      items = std::is_same_v<Item, Particle> ? "particles" : "springs";
    }
    throw std::invalid_argument(items + " in the request are " + std::to_string(count) +
                                "; allowed here: at most " + std::to_string(allowed) + why);
  }

  const core::SceneLimits limits_;
};

/// Returns the request that a service has got.
/// @throw std::invalid_argument for an array that is too long, and where bytes are missing.
template <class Request>
Request readRequest(const ros::SerializedMessage& message, const core::SceneLimits& limits) {
  RequestStream stream(message, limits);
  const std::uint32_t size = stream.getLength();
  Request request;
  try {
    stream.next(request);
  } catch (const ros::serialization::StreamOverrunException&) {
    throw std::invalid_argument(
        "the request ended too early: its " + std::to_string(size) + " byte" +
        (size == 1 ? " is" : "s are") + " fewer than " +
        ros::message_traits::DataType<Request>::value() +
        " needs; the client may have been built for another version of the package");
  }
  return request;
}

}  // namespace spherical_springs
