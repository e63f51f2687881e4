#include <gtest/gtest.h>

#include <boost/make_shared.hpp>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <new>
#include <stdexcept>

#include "node/callback_threads.h"

namespace spherical_springs {
namespace {

class Callback : public ros::CallbackInterface {
 public:
  explicit Callback(std::function<void()> work) : work_(std::move(work)) {}
  CallResult call() override {
    work_();
    return Success;
  }

 private:
  const std::function<void()> work_;
};

void call(CallbackThreads& threads, const std::function<void()>& work) {
  threads.queue().addCallback(boost::make_shared<Callback>(work), 1);
}

/// Something that threads wait for.
class Event {
 public:
  void happen() {
    const std::lock_guard<std::mutex> lock(mutex_);
    happened_ = true;
    changed_.notify_all();
  }
  void await() {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return happened_; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool happened_ = false;
};

TEST(CallbackThreads, OutliveWhatCallbacksThrow) {
  CallbackThreads threads(2);
  threads.start();
  for (int i = 0; i < 5; ++i) {
    call(threads, [] { throw std::runtime_error("thrown by a test"); });
    call(threads, [] { throw std::bad_alloc(); });
    call(threads, [] { throw 42; });
  }
  // One callback after another on each thread: both are there.
  Event first, second;
  call(threads, [&] {
    first.happen();
    second.await();
  });
  call(threads, [&] {
    first.await();
    second.happen();
  });
  second.await();
  threads.stop();
}

TEST(CallbackThreads, WaitForNoOtherQueue) {
  Event end, answered;
  CallbackThreads busy(1), other(1);
  busy.start();
  other.start();
  call(busy, [&] { end.await(); });
  call(other, [&] { answered.happen(); });
  answered.await();
  end.happen();
}

TEST(CallbackThreads, EndWhenTheCallbackUnderWayHas) {
  Event begun;
  bool ended = false, later = false;
  CallbackThreads threads(1);
  call(threads, [&] {
    begun.happen();
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    ended = true;
  });
  threads.start();
  begun.await();
  threads.stop();
  EXPECT_TRUE(ended);
  call(threads, [&] { later = true; });
  EXPECT_FALSE(later);
}

}  // namespace
}  // namespace spherical_springs
