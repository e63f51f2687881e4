#pragma once

#include <ros/serialization.h>

#include <boost/shared_array.hpp>
#include <cstddef>
#include <cstdint>

namespace spherical_springs {

/// A response on its way out. A call that changes something takes the memory for its answer before,
/// so that nothing can fail once the change is made.
template <class Service>
class Answer {
 public:
  typename Service::Response response;

  /// Takes the memory that it takes to send the response as it is now, with a message that may
  /// become as long as `message_size` bytes.
  /// @throw std::bad_alloc
  void reserve(std::size_t message_size = 0) {
    response.message.reserve(message_size);
    const std::size_t more = response.message.capacity() - response.message.size();
    const std::size_t size = kHeader + ros::serialization::serializationLength(response) + more;
    buffer_.reset(new std::uint8_t[size]);
    size_ = size;
  }

  /// The response as it goes over the wire. Takes no memory, and so cannot fail, where no array and
  /// no message has grown beyond what was reserved.
  /// @throw std::bad_alloc
  ros::SerializedMessage serialized(bool success) {
    response.success = success;
    const std::uint32_t length = ros::serialization::serializationLength(response);
    if (kHeader + length > size_) reserve();
    ros::SerializedMessage message(buffer_, kHeader + length);
    ros::serialization::OStream stream(buffer_.get(), kHeader + length);
    stream.next(std::uint8_t{1});  // the call came to an end, whatever it says of itself
    stream.next(length);
    stream.next(response);
    return message;
  }

 private:
  static constexpr std::size_t kHeader = 5;  // a flag and the length [bytes]

  boost::shared_array<std::uint8_t> buffer_;
  std::size_t size_ = 0;
};

}  // namespace spherical_springs
