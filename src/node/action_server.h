// Servers of actions whose goals are work for the threads that answer services.
#pragma once

#include <actionlib/server/action_server.h>
#include <ros/callback_queue_interface.h>
#include <ros/node_handle.h>

#include <boost/make_shared.hpp>
#include <chrono>
#include <exception>
#include <functional>
#include <optional>
#include <utility>

#include "node/faults.h"
#include "node/news.h"
#include "node/refusals.h"
#include "node/throttle.h"
#include "simulation/runner.h"

namespace spherical_springs {

/// The result of an action. `Work` has the types `ActionSpec`, `Progress` and `Doer`, the name
/// `kName`, and the functions `feedback`, which may return nothing, and `handle`, which fills the
/// result or throws.
template <class Work>
using ResultOf = typename Work::ActionSpec::_action_result_type::_result_type;

/// A goal while the work for it is done. Whoever has cancelled it, the client or ~cancel, it ends
/// as preempted.
template <class Work>
class GoalUnderWay : public core::Follower<typename Work::Progress> {
  using Clock = std::chrono::steady_clock;

 public:
  using Goal = actionlib::ServerGoalHandle<typename Work::ActionSpec>;
  using Result = ResultOf<Work>;
  using Progress = typename Work::Progress;

  explicit GoalUnderWay(const Goal& goal) : goal_(goal) {}

  bool goesOn(const Progress& progress) noexcept override {
    bool goes_on = true;
    runLoggingFaults("feedback of an action is left out", [&] {
      accept(progress);
      goes_on = goal_.getGoalStatus().status != actionlib_msgs::GoalStatus::PREEMPTING;
      const double elapsed = std::chrono::duration<double>(Clock::now() - begin_time_).count();
      if (!throttle_.isDue()) return;
      const auto feedback = Work::feedback(*begin_, progress, elapsed);
      if (feedback) goal_.publishFeedback(*feedback);
    });
    return goes_on;
  }

  void cancelled() noexcept override { cancelled_ = true; }
  bool wasCancelled() const { return cancelled_; }

  void end(Result& result) {
    accept({});
    result.success = true;
    if (cancelled_) {
      goal_.setCanceled(result, result.message);
    } else {
      goal_.setSucceeded(result, result.message);
    }
  }

  /// `result`: as far as it has come.
  void fail(Result& result, const char* reason) {
    result.success = false;
    result.message = reason;
    if (cancelled_) {
      goal_.setCanceled(result, reason);
    } else if (begin_) {
      goal_.setAborted(result, reason);
    } else {
      goal_.setRejected(result, reason);
    }
  }

 private:
  void accept(const Progress& progress) {
    if (begin_) return;
    begin_ = progress;
    begin_time_ = Clock::now();
    throttle_.isDue();  // there is nothing to tell yet
    goal_.setAccepted();
  }

  Goal goal_;
  std::optional<Progress> begin_;
  Clock::time_point begin_time_;
  Throttle throttle_{std::chrono::milliseconds(100)};
  bool cancelled_ = false;
};

/// Work for a thread that calls back.
class Task : public ros::CallbackInterface {
 public:
  explicit Task(std::function<void()> work) : work_(std::move(work)) {}

  CallResult call() override {
    work_();
    return Success;
  }

 private:
  const std::function<void()> work_;
};

/// One action.
template <class Work>
class WorkServer {
 public:
  /// The arguments must live longer. `doer` does the work.
  WorkServer(const ros::NodeHandle& receiving, ros::CallbackQueueInterface& calls,
             typename Work::Doer& doer, News& news)
      : calls_(calls),
        doer_(doer),
        news_(news),
        refusals_(Work::kName, news),
        // A goal sees for itself whether it has been cancelled.
        server_(
            receiving, Work::kName, [this](const Goal& goal) { receive(goal); }, [](const Goal&) {},
            false) {
    server_.start();
  }

 private:
  using Server = actionlib::ActionServer<typename Work::ActionSpec>;
  using Goal = typename Server::GoalHandle;

  void receive(const Goal& goal) {
    calls_.addCallback(boost::make_shared<Task>([this, goal] { work(goal); }));
  }

  void work(Goal goal) {
    if (goal.getGoalStatus().status == actionlib_msgs::GoalStatus::RECALLING) {
      constexpr auto kNothingDone = "cancelled before it began; nothing has changed";
      ResultOf<Work> result;
      result.message = kNothingDone;
      goal.setCanceled(result, kNothingDone);
      return;
    }
    const StatusChange told_at_the_end(news_);
    GoalUnderWay<Work> under_way(goal);
    ResultOf<Work> result;
    try {
      Work::handle(doer_, *goal.getGoal(), result, under_way);
    } catch (const std::exception& fault) {
      if (!under_way.wasCancelled()) refusals_.tell(fault);
      under_way.fail(result, reasonOf(fault));
      return;
    }
    under_way.end(result);
  }

  ros::CallbackQueueInterface& calls_;
  typename Work::Doer& doer_;
  News& news_;
  Refusals refusals_;
  Server server_;  // last, so that its callbacks end before what these use
};

}  // namespace spherical_springs
