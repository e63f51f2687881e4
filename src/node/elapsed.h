#pragma once

#include <ros/time.h>

#include <cstdint>

namespace spherical_springs {

/// The time from `begin` to `end` [s], negative where `end` is earlier. A ros::Duration holds 68
/// years at most, and throws beyond.
inline double secondsBetween(const ros::Time& begin, const ros::Time& end) {
  const auto nanoseconds = static_cast<std::int64_t>(end.toNSec() - begin.toNSec());
  return 1e-9 * static_cast<double>(nanoseconds);
}

}  // namespace spherical_springs
