#include "node/conversion.h"

#include <Eigen/Geometry>
#include <cmath>

namespace spherical_springs {
namespace {

template <class Message>
core::Vector3 toVector(const Message& message) {
  return {message.x, message.y, message.z};
}

template <class Message>
void setVector(const core::Vector3& vector, Message& message) {
  message.x = vector.x();
  message.y = vector.y();
  message.z = vector.z();
}

}  // namespace

core::Particle fromMessage(const Particle& message) {
  core::Particle particle;
  particle.position = toVector(message.position);
  particle.angular_velocity = toVector(message.angular_velocity);
  particle.mass = message.mass;
  particle.damping = message.damping;
  particle.pinned = message.pinned;
  return particle;
}

Particle toMessage(const core::Particle& particle) {
  Particle message;
  setVector(particle.position, message.position);
  setVector(particle.angular_velocity, message.angular_velocity);
  message.mass = particle.mass;
  message.damping = particle.damping;
  message.pinned = particle.pinned;
  return message;
}

Energies toMessage(const core::Energies& energies) {
  Energies message;
  message.kinetic = energies.kinetic;
  forEachKindInMessages([&](auto kind) {
    kind.energy(message) = energies.by_kind.get<typename decltype(kind)::Spring>().joules;
  });
  message.potential = energies.potential();
  message.total = energies.total();
  message.dissipated = energies.dissipated;
  return message;
}

Energies energiesOf(const core::Runner::Snapshot& snapshot, const std::string& frame_id) {
  Energies message = toMessage(core::energies(*snapshot.plan, snapshot.state));
  message.header.stamp = ros::Time::now();
  message.header.frame_id = frame_id;
  message.time = snapshot.state.time;
  return message;
}

// The turn from z to p, by half-angle formulas that do not cancel; at the south pole any axis will
// do.
geometry_msgs::Pose toPose(const core::Vector3& p, double radius) {
  geometry_msgs::Pose pose;
  setVector(radius * p, pose.position);
  auto& turn = pose.orientation;
  if (p.z() >= 0) {
    turn.w = std::sqrt((1 + p.z()) / 2);
    const double share = 0.5 / turn.w;  // of the sine of the whole angle
    turn.x = -share * p.y();
    turn.y = share * p.x();
    return pose;
  }
  const double across = std::sqrt(p.x() * p.x() + p.y() * p.y());
  const double sine = std::sqrt((1 - p.z()) / 2);
  turn.w = across / (2 * sine);
  turn.x = across > 0 ? -sine * p.y() / across : sine;
  turn.y = across > 0 ? sine * p.x() / across : 0;
  return pose;
}

core::TangentFrame axesOfPose(const core::Vector3& position) {
  const auto turn = toPose(position, 1).orientation;
  const Eigen::Matrix3d axes = Eigen::Quaterniond(turn.w, turn.x, turn.y, turn.z).matrix();
  return axes.leftCols<2>();
}

}  // namespace spherical_springs
