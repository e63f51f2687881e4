#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "node/conversion.h"

namespace spherical_springs {
namespace {

TEST(Conversion, OfAParticleAndBackIsTheSame) {
  Particle message;
  message.position.x = 1;
  message.position.y = 2;
  message.position.z = 3;
  message.angular_velocity.x = 4;
  message.angular_velocity.y = 5;
  message.angular_velocity.z = 6;
  message.mass = 7;
  message.damping = 8;
  message.pinned = true;
  EXPECT_EQ(toMessage(fromMessage(message)), message);
}

template <class Message>
Message springMessage() {
  Message message;
  for (std::size_t i = 0; i < message.particles.size(); ++i) message.particles[i] = 10 + i;
  message.stiffness = 1;
  message.damping = 2;
  message.at_rest = true;
  return message;
}

TEST(Conversion, OfSpringsAndBackIsTheSame) {
  auto angle = springMessage<AngleSpring>();
  angle.rest_angle = 3;
  EXPECT_EQ(toMessage(fromMessage(angle)), angle);
  auto solid_angle = springMessage<SolidAngleSpring>();
  solid_angle.rest_solid_angle = 3;
  EXPECT_EQ(toMessage(fromMessage(solid_angle)), solid_angle);
  auto oriented = springMessage<OrientedAngleSpring>();
  oriented.rest_angle = 3;
  oriented.width = 4;
  EXPECT_EQ(toMessage(fromMessage(oriented)), oriented);
}

TEST(Conversion, PosesHaveTheOutwardNormalAsZ) {
  for (const core::Vector3& direction :
       {core::Vector3(1, 2, 3), core::Vector3(-1, 2, -30), core::Vector3(0, 0, 1),
        core::Vector3(0, 0, -1), core::Vector3(1e-12, 0, -1)}) {
    const core::Vector3 p = direction.normalized();
    const auto pose = toPose(p, 2);
    const Eigen::Quaterniond q(pose.orientation.w, pose.orientation.x, pose.orientation.y,
                               pose.orientation.z);
    EXPECT_NEAR(q.norm(), 1, 1e-15);
    EXPECT_LT((q * core::Vector3::UnitZ() - p).norm(), 1e-15);
    EXPECT_EQ(core::Vector3(pose.position.x, pose.position.y, pose.position.z), 2 * p);
  }
}

}  // namespace
}  // namespace spherical_springs
