// Poses of particles on their way out.
#pragma once

#include <geometry_msgs/PoseArray.h>
#include <ros/message_traits.h>
#include <ros/serialization.h>

#include <cstdint>

#include "node/conversion.h"

namespace spherical_springs {

/// Goes out as a PoseArray, whose poses are made as they are written and lie nowhere else.
struct Poses {
  std_msgs::Header header;
  const core::Points& positions;
  double radius;  ///< [m]

  std::uint32_t count() const { return static_cast<std::uint32_t>(positions.cols()); }
};

}  // namespace spherical_springs

namespace ros {
namespace message_traits {

template <>
struct MD5Sum<spherical_springs::Poses> {
  static const char* value(const spherical_springs::Poses&) {
    return MD5Sum<geometry_msgs::PoseArray>::value();
  }
};

template <>
struct DataType<spherical_springs::Poses> {
  static const char* value(const spherical_springs::Poses&) {
    return DataType<geometry_msgs::PoseArray>::value();
  }
};

}  // namespace message_traits

namespace serialization {

template <>
struct Serializer<spherical_springs::Poses> {
  template <class Stream>
  static void write(Stream& stream, const spherical_springs::Poses& poses) {
    stream.next(poses.header);
    stream.next(poses.count());
    for (std::uint32_t i = 0; i < poses.count(); ++i) {
      stream.next(spherical_springs::toPose(poses.positions.col(i), poses.radius));
    }
  }

  static std::uint32_t serializedLength(const spherical_springs::Poses& poses) {
    const std::uint32_t of_one = serializationLength(geometry_msgs::Pose());
    return serializationLength(poses.header) + serializationLength(poses.count()) +
           poses.count() * of_one;
  }
};

}  // namespace serialization
}  // namespace ros
