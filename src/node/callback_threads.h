#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>

#include <atomic>
#include <thread>
#include <vector>

namespace spherical_springs {

/// Threads with a queue of their own, on which ROS calls the node back. They wait for no other
/// queue's work, and outlive what a callback throws, which would end ROS's own spinners, and with
/// them the node.
class CallbackThreads {
 public:
  explicit CallbackThreads(int count) : count_(count) {}
  ~CallbackThreads() { stop(); }
  CallbackThreads(const CallbackThreads&) = delete;
  CallbackThreads& operator=(const CallbackThreads&) = delete;

  /// The queue, for things that must not outlive these threads.
  ros::CallbackQueueInterface& queue() { return queue_; }

  /// `node` with this queue: its timers, services and listeners call back here.
  ros::NodeHandle handle(ros::NodeHandle node) {
    node.setCallbackQueue(&queue_);
    return node;
  }

  /// Callbacks that come before wait for it.
  void start();

  /// Returns when the callbacks under way have ended; there will be no more.
  void stop();

 private:
  /// Lets callbacks throw.
  class Queue : public ros::CallbackQueue {
   public:
    void addCallback(const ros::CallbackInterfacePtr& callback, std::uint64_t owner) override;
  };

  void callBack();

  const int count_;
  Queue queue_;
  std::atomic<bool> stopped_{false};
  std::vector<std::thread> threads_;
};

}  // namespace spherical_springs
