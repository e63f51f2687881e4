#pragma once

#include <ros/console.h>

#include <exception>

namespace spherical_springs {

/// Does `work` and outlives what it throws, such as a lack of memory: the log tells of it.
template <class Work>
void survive(const Work& work) {
  constexpr double kQuiet = 10;  // [s]
  try {
    work();
  } catch (const std::exception& fault) {
    ROS_ERROR_THROTTLE(kQuiet, "a tick of a timer failed: %s", fault.what());
  }
}

/// A callback of a timer that survives `work`, and tries again at the next tick. ROS would end the
/// node.
template <class Work>
auto surviving(const Work& work) {
  return [work](const auto&) { survive(work); };
}

}  // namespace spherical_springs
