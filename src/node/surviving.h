#pragma once

#include <ros/console.h>

#include <exception>

namespace spherical_springs {

/// A callback of a timer that outlives what `work` throws, such as a lack of memory: the log tells
/// of it, and the next tick tries again. ROS would end the node.
template <class Work>
auto surviving(const Work& work) {
  return [work](const auto&) {
    constexpr double kQuiet = 10;  // [s]
    try {
      work();
    } catch (const std::exception& fault) {
      ROS_ERROR_THROTTLE(kQuiet, "a tick of a timer failed: %s", fault.what());
    }
  };
}

}  // namespace spherical_springs
