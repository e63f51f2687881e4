// Between the messages and the core, both ways. Nothing is checked here: the scene does that.
#pragma once

#include <geometry_msgs/Pose.h>
#include <spherical_springs/Energies.h>
#include <spherical_springs/Particle.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "node/kinds.h"
#include "simulation/runner.h"
#include "spherical_springs/measures.h"
#include "spherical_springs/range.h"
#include "spherical_springs/scene.h"

namespace spherical_springs {

core::Particle fromMessage(const Particle& message);
Particle toMessage(const core::Particle& particle);

/// Copies a spring of the core's type `Spring` from or to its message.
template <class Spring, class From, class To>
void copySpring(const From& from, To& to) {
  std::copy(from.particles.begin(), from.particles.end(), to.particles.begin());
  to.at_rest = from.at_rest;
  std::array<double, sizeof(Spring) / sizeof(double)> values;  // more than there are fields
  std::size_t count = 0;
  Spring::visitFields(
      from, [&](const char*, double value, const core::Range&) { values[count++] = value; });
  count = 0;
  Spring::visitFields(
      to, [&](const char*, double& value, const core::Range&) { value = values[count++]; });
}

template <class Spring>
Spring springFrom(const typename KindInMessages<Spring>::Message& message) {
  Spring spring;
  copySpring<Spring>(message, spring);
  return spring;
}

template <class Spring>
typename KindInMessages<Spring>::Message toMessage(const Spring& spring) {
  typename KindInMessages<Spring>::Message message;
  copySpring<Spring>(spring, message);
  return message;
}

/// The header's stamp and frame, and the simulated time, are left to the caller.
Energies toMessage(const core::Energies& energies);

/// The energies of `snapshot`, stamped with the present time.
Energies energiesOf(const core::Runner::Snapshot& snapshot, const std::string& frame_id);

/// The pose of a particle on a sphere of radius `radius` [m]: +z is the outward normal, by the
/// shortest turn from the frame's own z.
geometry_msgs::Pose toPose(const core::Vector3& position, double radius);

/// The x and y axes of the pose of a particle, in the scene's.
core::TangentFrame axesOfPose(const core::Vector3& position);

template <class Message>
auto fromMessages(const std::vector<Message>& messages) {
  std::vector<decltype(fromMessage(messages.front()))> items;
  items.reserve(messages.size());
  for (const Message& message : messages) items.push_back(fromMessage(message));
  return items;
}

/// The springs of all kinds that a request holds.
template <class Request>
core::SpringLists springsFrom(const Request& request) {
  core::SpringLists springs;
  forEachKindInMessages([&](auto kind) {
    using Spring = typename decltype(kind)::Spring;
    auto& list = springs.get<Spring>();
    list.reserve(kind.springs(request).size());
    for (const auto& message : kind.springs(request)) list.push_back(springFrom<Spring>(message));
  });
  return springs;
}

/// The ids of springs of all kinds that a request holds.
template <class Request>
core::SpringIds springIdsFrom(const Request& request) {
  core::SpringIds ids;
  forEachKindInMessages([&](auto kind) {
    const auto& from = kind.ids(request);
    ids.get<typename decltype(kind)::Spring>().assign(from.begin(), from.end());
  });
  return ids;
}

template <class Response>
void setSpringIds(core::SpringIds&& ids, Response& response) noexcept {
  forEachKindInMessages([&](auto kind) {
    kind.ids(response) = std::move(ids.get<typename decltype(kind)::Spring>());
  });
}

}  // namespace spherical_springs
