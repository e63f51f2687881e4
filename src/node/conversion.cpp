#include "node/conversion.h"

#include <algorithm>
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

/// The fields that springs of all kinds share.
template <class From, class To>
void copyCommon(const From& from, To& to) {
  std::copy(from.particles.begin(), from.particles.end(), to.particles.begin());
  to.stiffness = from.stiffness;
  to.damping = from.damping;
  to.at_rest = from.at_rest;
}

template <class To, class From>
To angleSpring(const From& from) {
  To to;
  copyCommon(from, to);
  to.rest_angle = from.rest_angle;
  return to;
}

template <class To, class From>
To solidAngleSpring(const From& from) {
  To to;
  copyCommon(from, to);
  to.rest_solid_angle = from.rest_solid_angle;
  return to;
}

template <class To, class From>
To orientedAngleSpring(const From& from) {
  To to;
  copyCommon(from, to);
  to.rest_angle = from.rest_angle;
  to.width = from.width;
  return to;
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

core::AngleSpring fromMessage(const AngleSpring& message) {
  return angleSpring<core::AngleSpring>(message);
}
AngleSpring toMessage(const core::AngleSpring& spring) { return angleSpring<AngleSpring>(spring); }

core::SolidAngleSpring fromMessage(const SolidAngleSpring& message) {
  return solidAngleSpring<core::SolidAngleSpring>(message);
}
SolidAngleSpring toMessage(const core::SolidAngleSpring& spring) {
  return solidAngleSpring<SolidAngleSpring>(spring);
}

core::OrientedAngleSpring fromMessage(const OrientedAngleSpring& message) {
  return orientedAngleSpring<core::OrientedAngleSpring>(message);
}
OrientedAngleSpring toMessage(const core::OrientedAngleSpring& spring) {
  return orientedAngleSpring<OrientedAngleSpring>(spring);
}

Energies toMessage(const core::Energies& energies) {
  Energies message;
  message.kinetic = energies.kinetic;
  message.angle = energies.by_kind.get<core::AngleSpring>().joules;
  message.solid_angle = energies.by_kind.get<core::SolidAngleSpring>().joules;
  message.oriented_angle = energies.by_kind.get<core::OrientedAngleSpring>().joules;
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

}  // namespace spherical_springs
