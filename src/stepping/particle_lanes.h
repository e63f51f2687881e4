// Arrays over particles, to lanes and back.
#pragma once

#include "base/lanes.h"

namespace {

template <class Arrays>
inline Lanes3 loadVelocities(const Arrays& particles, std::uint32_t first) {
  return {load(particles.velocities[0] + first), load(particles.velocities[1] + first),
          load(particles.velocities[2] + first)};
}

inline void store(const Lanes& values, double* to) {
  __builtin_memcpy(to, &values, sizeof(values));
}

template <class Arrays>
inline void storeVelocities(const Lanes3& v, const Arrays& particles, std::uint32_t first) {
  store(v.x, particles.velocities[0] + first);
  store(v.y, particles.velocities[1] + first);
  store(v.z, particles.velocities[2] + first);
}

}  // namespace
