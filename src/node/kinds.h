// How messages and services name each kind of spring. A new kind has its trait here; all else in
// the node loops over the traits.
#pragma once

#include <spherical_springs/AngleSpring.h>
#include <spherical_springs/Energies.h>
#include <spherical_springs/OrientedAngleSpring.h>
#include <spherical_springs/SolidAngleSpring.h>

#include <cstddef>

#include "spherical_springs/springs/kinds.h"

namespace spherical_springs {

/// A kind of spring in messages. `Message` has the fields of the core's `Spring` under the same
/// names. Each function returns the field of that kind: `springs` and `ids` that of a request or a
/// response, `count` that of a Status, `energy` that of an Energies, `conditions` and `energies`
/// those of the answer of ~get_strains.
template <class Spring>
struct KindInMessages;

template <>
struct KindInMessages<core::AngleSpring> {
  using Spring = core::AngleSpring;
  using Message = AngleSpring;

  template <class Body>
  static auto& springs(Body& body) {
    return body.angle_springs;
  }
  template <class Body>
  static auto& ids(Body& body) {
    return body.angle_spring_ids;
  }
  template <class Status>
  static auto& count(Status& status) {
    return status.angle_springs;
  }
  static double& energy(Energies& energies) { return energies.angle; }
  template <class Strains>
  static auto& conditions(Strains& strains) {
    return strains.angle_conditions;
  }
  template <class Strains>
  static auto& energies(Strains& strains) {
    return strains.angle_energies;
  }
};

template <>
struct KindInMessages<core::SolidAngleSpring> {
  using Spring = core::SolidAngleSpring;
  using Message = SolidAngleSpring;

  template <class Body>
  static auto& springs(Body& body) {
    return body.solid_angle_springs;
  }
  template <class Body>
  static auto& ids(Body& body) {
    return body.solid_angle_spring_ids;
  }
  template <class Status>
  static auto& count(Status& status) {
    return status.solid_angle_springs;
  }
  static double& energy(Energies& energies) { return energies.solid_angle; }
  template <class Strains>
  static auto& conditions(Strains& strains) {
    return strains.solid_angle_conditions;
  }
  template <class Strains>
  static auto& energies(Strains& strains) {
    return strains.solid_angle_energies;
  }
};

template <>
struct KindInMessages<core::OrientedAngleSpring> {
  using Spring = core::OrientedAngleSpring;
  using Message = OrientedAngleSpring;

  template <class Body>
  static auto& springs(Body& body) {
    return body.oriented_angle_springs;
  }
  template <class Body>
  static auto& ids(Body& body) {
    return body.oriented_angle_spring_ids;
  }
  template <class Status>
  static auto& count(Status& status) {
    return status.oriented_angle_springs;
  }
  static double& energy(Energies& energies) { return energies.oriented_angle; }
  template <class Strains>
  static auto& conditions(Strains& strains) {
    return strains.oriented_angle_conditions;
  }
  template <class Strains>
  static auto& energies(Strains& strains) {
    return strains.oriented_angle_energies;
  }
};

/// Calls `visit(KindInMessages<Spring>())` for each kind of spring, always in the same order.
template <class Visitor>
void forEachKindInMessages(Visitor&& visit) {
  core::forEachKind([&](auto kind) { visit(KindInMessages<typename decltype(kind)::type>()); });
}

/// Returns how many springs of all kinds a request or a response holds.
template <class Body>
std::size_t springCount(const Body& body) {
  std::size_t count = 0;
  forEachKindInMessages([&](auto kind) { count += kind.springs(body).size(); });
  return count;
}

/// Returns how many ids of springs of all kinds a request or a response holds.
template <class Body>
std::size_t springIdCount(const Body& body) {
  std::size_t count = 0;
  forEachKindInMessages([&](auto kind) { count += kind.ids(body).size(); });
  return count;
}

}  // namespace spherical_springs
