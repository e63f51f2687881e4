// Between the messages and the core, both ways. Nothing is checked here: the scene does that.
#pragma once

#include <geometry_msgs/Pose.h>
#include <spherical_springs/AngleSpring.h>
#include <spherical_springs/Energies.h>
#include <spherical_springs/OrientedAngleSpring.h>
#include <spherical_springs/Particle.h>
#include <spherical_springs/SolidAngleSpring.h>

#include <string>
#include <utility>
#include <vector>

#include "simulation/runner.h"
#include "spherical_springs/measures.h"
#include "spherical_springs/scene.h"

namespace spherical_springs {

core::Particle fromMessage(const Particle& message);
core::AngleSpring fromMessage(const AngleSpring& message);
core::SolidAngleSpring fromMessage(const SolidAngleSpring& message);
core::OrientedAngleSpring fromMessage(const OrientedAngleSpring& message);

Particle toMessage(const core::Particle& particle);
AngleSpring toMessage(const core::AngleSpring& spring);
SolidAngleSpring toMessage(const core::SolidAngleSpring& spring);
OrientedAngleSpring toMessage(const core::OrientedAngleSpring& spring);

/// The header's stamp and frame, and the simulated time, are left to the caller.
Energies toMessage(const core::Energies& energies);

/// The energies of `snapshot`, stamped with the present time.
Energies energiesOf(const core::Runner::Snapshot& snapshot, const std::string& frame_id);

/// The pose of a particle on a sphere of radius `radius` [m]: +z is the outward normal, by the
/// shortest turn from the frame's own z.
geometry_msgs::Pose toPose(const core::Vector3& position, double radius);

template <class Message>
auto fromMessages(const std::vector<Message>& messages) {
  std::vector<decltype(fromMessage(messages.front()))> items;
  items.reserve(messages.size());
  for (const Message& message : messages) items.push_back(fromMessage(message));
  return items;
}

/// The three arrays of springs, and of their ids, that requests and responses have in common.
template <class Message>
core::SpringLists springsFrom(const Message& message) {
  core::SpringLists springs;
  const auto fill = [](auto& list, const auto& messages) {
    list.reserve(messages.size());
    for (const auto& item : messages) list.push_back(fromMessage(item));
  };
  fill(springs.get<core::AngleSpring>(), message.angle_springs);
  fill(springs.get<core::SolidAngleSpring>(), message.solid_angle_springs);
  fill(springs.get<core::OrientedAngleSpring>(), message.oriented_angle_springs);
  return springs;
}

template <class Message>
core::SpringIds springIdsFrom(const Message& message) {
  core::SpringIds ids;
  const auto fill = [](auto& list, const auto& from) { list.assign(from.begin(), from.end()); };
  fill(ids.get<core::AngleSpring>(), message.angle_spring_ids);
  fill(ids.get<core::SolidAngleSpring>(), message.solid_angle_spring_ids);
  fill(ids.get<core::OrientedAngleSpring>(), message.oriented_angle_spring_ids);
  return ids;
}

template <class Message>
void setSpringIds(core::SpringIds&& ids, Message& message) noexcept {
  message.angle_spring_ids = std::move(ids.get<core::AngleSpring>());
  message.solid_angle_spring_ids = std::move(ids.get<core::SolidAngleSpring>());
  message.oriented_angle_spring_ids = std::move(ids.get<core::OrientedAngleSpring>());
}

}  // namespace spherical_springs
