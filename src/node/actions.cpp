#include "node/actions.h"

#include <actionlib/server/action_server.h>
#include <ros/serialization.h>
#include <spherical_springs/RelaxAction.h>
#include <spherical_springs/StepAction.h>

#include <boost/make_shared.hpp>
#include <chrono>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "node/faults.h"
#include "node/refusals.h"
#include "node/throttle.h"

namespace spherical_springs {
namespace {

using Clock = std::chrono::steady_clock;
using actionlib_msgs::GoalStatus;

/// Copies a message into one of another name that has the same fields.
template <class To, class From>
To sameFields(const From& from) {
  using ros::message_traits::MD5Sum;
  static_assert(MD5Sum<To>::static_value1 == MD5Sum<From>::static_value1 &&
                    MD5Sum<To>::static_value2 == MD5Sum<From>::static_value2,
                "an action has the fields of the service of its name");
  const ros::SerializedMessage bytes = ros::serialization::serializeMessage(from);
  ros::serialization::IStream stream(bytes.message_start,
                                     ros::serialization::serializationLength(from));
  To to;
  stream.next(to);
  return to;
}

struct RelaxWork {
  using ActionSpec = RelaxAction;
  using Service = Relax;
  using Progress = core::RelaxProgress;

  static constexpr auto kName = "relax";

  static std::optional<RelaxFeedback> feedback(const Progress&, const Progress& now,
                                               double elapsed) {
    if (now.best == nullptr) return {};
    RelaxFeedback feedback;
    feedback.progress = now.fraction;
    feedback.iterations = now.best->iterations;
    feedback.energy = now.best->energy_after;
    feedback.max_torque = now.best->max_torque;
    feedback.wall_time = elapsed;
    return feedback;
  }

  static void handle(Handlers& handlers, const Relax::Request& request, Answer<Relax>& answer,
                     core::RelaxFollower& follower) {
    handlers.relax(request, answer, &follower);
  }
};

struct StepWork {
  using ActionSpec = StepAction;
  using Service = Step;
  using Progress = core::StepProgress;

  static constexpr auto kName = "step";

  static std::optional<StepFeedback> feedback(const Progress& begin, const Progress& now,
                                              double elapsed) {
    StepFeedback feedback;
    feedback.steps = now.steps;
    feedback.time = now.time;
    feedback.real_time_factor = (now.time - begin.time) / elapsed;
    return feedback;
  }

  static void handle(Handlers& handlers, const Step::Request& request, Answer<Step>& answer,
                     core::StepFollower& follower) {
    handlers.step(request, answer, &follower);
  }
};

template <class Work>
using ResultOf = typename Work::ActionSpec::_action_result_type::_result_type;

/// A goal while the work for it is done. Whoever has cancelled it, the client or ~cancel, it ends
/// as preempted.
template <class Work>
class GoalUnderWay : public core::Follower<typename Work::Progress> {
 public:
  using Goal = actionlib::ServerGoalHandle<typename Work::ActionSpec>;
  using Result = ResultOf<Work>;
  using Progress = typename Work::Progress;

  explicit GoalUnderWay(const Goal& goal) : goal_(goal) {}

  bool goesOn(const Progress& progress) noexcept override {
    bool goes_on = true;
    runLoggingFaults("feedback of an action is left out", [&] {
      accept(progress);
      goes_on = goal_.getGoalStatus().status != GoalStatus::PREEMPTING;
      const double elapsed = std::chrono::duration<double>(Clock::now() - begin_time_).count();
      if (!throttle_.isDue()) return;
      const auto feedback = Work::feedback(*begin_, progress, elapsed);
      if (feedback) goal_.publishFeedback(*feedback);
    });
    return goes_on;
  }

  void cancelled() noexcept override { cancelled_ = true; }

  void end(typename Work::Service::Response& response) {
    accept({});
    response.success = true;
    const auto result = sameFields<Result>(response);
    if (cancelled_) {
      goal_.setCanceled(result, result.message);
    } else {
      goal_.setSucceeded(result, result.message);
    }
  }

  void fail(const char* reason) {
    Result result;
    result.message = reason;
    if (begin_) {
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
  WorkServer(const ros::NodeHandle& receiving, ros::CallbackQueueInterface& calls,
             Handlers& handlers, News& news)
      : calls_(calls),
        handlers_(handlers),
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
  using Service = typename Work::Service;

  void receive(const Goal& goal) {
    calls_.addCallback(boost::make_shared<Task>([this, goal] { work(goal); }));
  }

  void work(Goal goal) {
    if (goal.getGoalStatus().status == GoalStatus::RECALLING) {
      constexpr auto kNothingDone = "cancelled before it began; nothing has changed";
      ResultOf<Work> result;
      result.message = kNothingDone;
      goal.setCanceled(result, kNothingDone);
      return;
    }
    const StatusChange told_at_the_end(news_);
    GoalUnderWay<Work> under_way(goal);
    Answer<Service> answer;
    try {
      const auto request = sameFields<typename Service::Request>(*goal.getGoal());
      Work::handle(handlers_, request, answer, under_way);
    } catch (const std::exception& fault) {
      refusals_.tell(fault);
      under_way.fail(reasonOf(fault));
      return;
    }
    under_way.end(answer.response);
  }

  ros::CallbackQueueInterface& calls_;
  Handlers& handlers_;
  News& news_;
  Refusals refusals_;
  Server server_;  // last, so that its callbacks end before what these use
};

}  // namespace

Actions::Actions(const ros::NodeHandle& receiving, ros::CallbackQueueInterface& calls,
                 Handlers& handlers, News& news)
    : servers_{std::make_shared<WorkServer<RelaxWork>>(receiving, calls, handlers, news),
               std::make_shared<WorkServer<StepWork>>(receiving, calls, handlers, news)} {}

}  // namespace spherical_springs
