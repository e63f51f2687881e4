#include <gtest/gtest.h>
#include <spherical_springs/AddSprings.h>
#include <spherical_springs/SetSprings.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

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

/// A spring with another value in each byte of its fields, whatever they are.
template <class Message>
Message springMessage() {
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(Message()));
  std::iota(bytes.begin(), bytes.end(), std::uint8_t{1});
  bytes.back() = 1;  // at_rest, which is true
  ros::serialization::IStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  Message message;
  stream.next(message);
  return message;
}

TEST(Conversion, OfSpringsKeepsEveryField) {
  forEachKindInMessages([](auto kind) {
    using Spring = typename decltype(kind)::Spring;
    SCOPED_TRACE(Spring::kName);
    const auto message = springMessage<typename decltype(kind)::Message>();
    const auto spring = springFrom<Spring>(message);
    EXPECT_EQ(toMessage(spring), message);
    EXPECT_TRUE(spring.at_rest);
    EXPECT_TRUE(std::equal(spring.particles.begin(), spring.particles.end(),
                           message.particles.begin(), message.particles.end()));
    EXPECT_EQ(spring.stiffness, message.stiffness);
    EXPECT_EQ(spring.damping, message.damping);
  });
}

TEST(Conversion, OfSpringsKeepsRestValuesApart) {
  const auto angle = springMessage<AngleSpring>();
  EXPECT_EQ(springFrom<core::AngleSpring>(angle).rest_angle, angle.rest_angle);
  const auto solid_angle = springMessage<SolidAngleSpring>();
  EXPECT_EQ(springFrom<core::SolidAngleSpring>(solid_angle).rest_solid_angle,
            solid_angle.rest_solid_angle);
  const auto oriented = springMessage<OrientedAngleSpring>();
  EXPECT_EQ(springFrom<core::OrientedAngleSpring>(oriented).rest_angle, oriented.rest_angle);
  EXPECT_EQ(springFrom<core::OrientedAngleSpring>(oriented).width, oriented.width);
}

/// A request or response with `count` springs of the first kind, one more of each next, and ids.
template <class Body>
Body withSprings(std::size_t count) {
  Body body;
  forEachKindInMessages([&](auto kind) {
    using Message = typename decltype(kind)::Message;
    kind.springs(body).assign(count++, springMessage<Message>());
    kind.ids(body).assign(count, 7);
  });
  return body;
}

TEST(Conversion, OfRequestsTakesEachKindFromItsOwnArrays) {
  const auto request = withSprings<SetSprings::Request>(2);
  ASSERT_EQ(request.angle_springs.size(), 2u);
  ASSERT_EQ(request.solid_angle_springs.size(), 3u);
  ASSERT_EQ(request.oriented_angle_springs.size(), 4u);
  ASSERT_EQ(request.angle_spring_ids.size(), 3u);
  ASSERT_EQ(request.solid_angle_spring_ids.size(), 4u);
  ASSERT_EQ(request.oriented_angle_spring_ids.size(), 5u);
  EXPECT_EQ(springCount(request), 9u);
  EXPECT_EQ(springIdCount(request), 12u);
  const auto springs = springsFrom(request);
  EXPECT_EQ(springs.get<core::AngleSpring>().size(), 2u);
  EXPECT_EQ(springs.get<core::SolidAngleSpring>().size(), 3u);
  EXPECT_EQ(springs.get<core::OrientedAngleSpring>().size(), 4u);
  auto ids = springIdsFrom(request);
  EXPECT_EQ(ids.get<core::OrientedAngleSpring>().size(), 5u);
  AddSprings::Response response;
  setSpringIds(std::move(ids), response);
  EXPECT_EQ(response.angle_spring_ids, request.angle_spring_ids);
  EXPECT_EQ(response.solid_angle_spring_ids, request.solid_angle_spring_ids);
  EXPECT_EQ(response.oriented_angle_spring_ids, request.oriented_angle_spring_ids);
}

TEST(Conversion, OfEnergiesAddsUp) {
  core::Energies energies;
  energies.by_kind.get<core::AngleSpring>().joules = 1;
  energies.by_kind.get<core::SolidAngleSpring>().joules = 2;
  energies.by_kind.get<core::OrientedAngleSpring>().joules = 4;
  energies.kinetic = 8;
  const Energies message = toMessage(energies);
  EXPECT_EQ(message.angle, 1);
  EXPECT_EQ(message.solid_angle, 2);
  EXPECT_EQ(message.oriented_angle, 4);
  EXPECT_EQ(message.potential, 7);
  EXPECT_EQ(message.total, 15);
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
