#include "node/callback_threads.h"

#include <boost/make_shared.hpp>
#include <csignal>
#include <utility>

#include "node/faults.h"

namespace spherical_springs {
namespace {

/// A callback that throws nothing: ROS's queues are not made for that.
class SurvivingCallback : public ros::CallbackInterface {
 public:
  explicit SurvivingCallback(ros::CallbackInterfacePtr callback) : callback_(std::move(callback)) {}

  CallResult call() override {
    CallResult result = Invalid;
    runLoggingFaults("a callback failed", [&] { result = callback_->call(); });
    return result;
  }

  bool ready() override { return callback_->ready(); }

 private:
  const ros::CallbackInterfacePtr callback_;
};

/// Leaves signals to the main thread, as ROS's own spinners do.
void blockSignals() {
  sigset_t all;
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, nullptr);
}

}  // namespace

void CallbackThreads::Queue::addCallback(const ros::CallbackInterfacePtr& callback,
                                         std::uint64_t owner) {
  ros::CallbackQueue::addCallback(boost::make_shared<SurvivingCallback>(callback), owner);
}

void CallbackThreads::start() {
  for (int i = 0; i < count_; ++i) threads_.emplace_back([this] { callBack(); });
}

void CallbackThreads::stop() {
  stopped_ = true;
  queue_.disable();  // wakes the threads
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
}

void CallbackThreads::callBack() {
  const ros::WallDuration kPatience(1);
  blockSignals();
  while (!stopped_) {
    runLoggingFaults("callbacks could not be called", [&] { queue_.callOne(kPatience); });
  }
}

}  // namespace spherical_springs
