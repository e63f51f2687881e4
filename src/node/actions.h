#pragma once

#include <ros/callback_queue_interface.h>
#include <ros/node_handle.h>

#include <memory>
#include <vector>

#include "node/handlers.h"
#include "node/map_handler.h"
#include "node/news.h"

namespace spherical_springs {

/// The actions ~relax and ~step, which are the services of these names for clients that do not wait
/// in a call, and ~map_mesh. A goal is work for the threads that answer services, and is refused as
/// a call would be.
/// (The SimpleActionServer of actionlib would let a new goal preempt the one under way, or wait for
/// it.)
class Actions {
 public:
  /// `receiving`: a handle for goals and cancels, whose callbacks take no time. `calls`: the queue
  /// of the threads that do the work. What is passed must live longer.
  Actions(const ros::NodeHandle& receiving, ros::CallbackQueueInterface& calls, Handlers& handlers,
          MapHandler& mapper, News& news);

 private:
  std::vector<std::shared_ptr<void>> servers_;  // one an action, of different types
};

}  // namespace spherical_springs
