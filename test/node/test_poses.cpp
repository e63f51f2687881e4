#include <gtest/gtest.h>

#include "node/poses.h"

namespace spherical_springs {
namespace {

template <class Message>
std::vector<std::uint8_t> bytesOf(const Message& message) {
  const ros::SerializedMessage out = ros::serialization::serializeMessage(message);
  return {out.buf.get(), out.buf.get() + out.num_bytes};
}

TEST(Poses, GoOutAsAPoseArray) {
  for (const Eigen::Index count : {0, 1, 100}) {
    core::Points positions = core::Points::Random(3, count);
    positions.colwise().normalize();
    geometry_msgs::PoseArray expected;
    expected.header.seq = 7;
    expected.header.stamp = ros::Time(12, 34);
    expected.header.frame_id = "globe";
    for (Eigen::Index i = 0; i < count; ++i) {
      expected.poses.push_back(toPose(positions.col(i), 6.5));
    }
    const Poses poses = {expected.header, positions, 6.5};
    EXPECT_EQ(bytesOf(poses), bytesOf(expected));
    EXPECT_STREQ(ros::message_traits::md5sum(poses), ros::message_traits::md5sum(expected));
    EXPECT_STREQ(ros::message_traits::datatype(poses), ros::message_traits::datatype(expected));
  }
}

}  // namespace
}  // namespace spherical_springs
