#pragma once

#include <boost/signals2/connection.hpp>
#include <new>

namespace spherical_springs {

/// Memory for the one thread on which roscpp reads requests, which ends the process where an
/// allocation fails. While this lives, such an allocation gets memory that was held in reserve for
/// it; where that is not enough it waits, up to half a minute, for what others give back. For the
/// rest of the process nothing changes. One at a time.
class RequestMemory {
 public:
  /// ROS must have been started.
  RequestMemory();
  ~RequestMemory();
  RequestMemory(const RequestMemory&) = delete;
  RequestMemory& operator=(const RequestMemory&) = delete;

 private:
  boost::signals2::connection at_each_poll_;
  std::new_handler earlier_handler_;
};

}  // namespace spherical_springs
