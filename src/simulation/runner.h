// One simulation for many callers at once.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>

#include "simulation/cancellable_relaxer.h"
#include "spherical_springs/relaxation.h"
#include "spherical_springs/simulation.h"

namespace spherical_springs::core {

/// A mutex that lets waiting callers in before the last holder comes back: a loop that takes it
/// again and again cannot starve the others.
class FairMutex {
 public:
  void lock() {
    const std::lock_guard<std::mutex> turn(next_);
    held_.lock();
  }
  void unlock() { held_.unlock(); }

 private:
  std::mutex next_, held_;
};

enum class Activity { none, stepping, relaxing };

/// Refuses a call that does not go with what the runner does at the time.
class Refusal : public std::runtime_error {
 public:
  enum class Reason { stepping, relaxing, running, closed };

  Refusal(Reason reason, const char* what) : std::runtime_error(what), reason_(reason) {}
  Reason reason() const { return reason_; }

 private:
  Reason reason_;
};

/// Follows a step or relaxation on the thread of its caller, and may cancel it.
template <class Progress>
class Follower {
 public:
  virtual ~Follower() = default;

  /// Called when the work begins, as it is not refused any more, and then every few milliseconds.
  /// @return false to cancel the work.
  virtual bool goesOn(const Progress& progress) noexcept = 0;

  /// Called where the work has been cancelled, by `goesOn` or by another caller.
  virtual void cancelled() noexcept = 0;
};

/// How far a step under way has come.
struct StepProgress {
  std::uint64_t steps;  ///< that are done
  double time;          ///< simulated [s]
};

/// How far a relaxation under way has come.
struct RelaxProgress {
  const RelaxationResult* best;  ///< what it would be if it ended now; null before an iteration
  double fraction;               ///< of the way, as RelaxationProgress has it
};

using StepFollower = Follower<StepProgress>;
using RelaxFollower = Follower<RelaxProgress>;

/// Steps and relaxes a simulation, and lets others read it meanwhile: stepping pauses for them
/// every few milliseconds; a relaxation works on a copy, on a thread of its own, and shows how far
/// it has come. Changes are refused until either ends. All functions may be called from any thread.
/// A call that throws has changed nothing.
class Runner {
 public:
  Runner(const Simulation::Settings& settings, bool running)
      : simulation_(settings), running_(running) {}

  /// `use(simulation)` for one that only looks; returns what it returns.
  template <class Use>
  auto read(const Use& use) {
    const std::lock_guard<FairMutex> lock(mutex_);
    return use(simulation_);
  }

  /// `change(simulation)`; returns what it returns.
  /// @throw Refusal while a step or relaxation is under way, and what `change` throws.
  template <class Change>
  auto change(const Change& change) {
    const std::lock_guard<FairMutex> lock(mutex_);
    requireIdle();
    const TopologyWatch watch(*this);
    return change(simulation_);
  }

  /// @throw Refusal while a step or relaxation is under way.
  void setRunning(bool running);

  bool isRunning() const;

  /// Says all at once, between two steps, how the steps to come are to be, as `Simulation::stepBy`
  /// does, and whether to run; no value of `running` leaves that as it is.
  /// @throw Refusal where a step under way would go on by another wish, and as `setRunning` does
  /// where `running` changes; what `Simulation::stepBy` throws.
  /// @return how the next step is done.
  StepChoice stepBy(const StepWish& wish, std::optional<bool> running = {});

  /// Returns how the next step is done, chosen if it was not yet, unless a relaxation is under way.
  /// @throw std::bad_alloc.
  StepChoice choice();

  /// The rest of a duration after `advance`, which is less than a step unless time was short.
  struct Left {
    double duration;   ///< [s]
    double time_step;  ///< [s]
  };
  /// As many steps as fit into `duration` [s] and into the time that `wall_time` [s] allows, if
  /// running and idle.
  Left advance(double duration, double wall_time);

  /// Steps done by a call.
  struct Done {
    std::uint64_t steps = 0;
    double time = 0;  ///< simulated [s]
  };
  /// Counts the steps that are still to be done, of a time step [s]. Asked at first, and again
  /// where the time step may have changed.
  using StepCount = std::function<std::uint64_t(double time_step, const Done& done)>;

  /// As many steps as `count` says, unless cancelled; then `report()`, while changes are still
  /// refused. The wish does not change meanwhile. Where `count` or `report` throws, the steps are
  /// undone. `follower`: null for none.
  /// @throw Refusal unless paused and idle, and what `count` and `report` throw.
  Done step(const StepCount& count, const std::function<void()>& report,
            StepFollower* follower = nullptr);
  std::uint64_t step(std::uint64_t steps, const std::function<void()>& report) {
    return step([steps](double, const Done& done) { return steps - done.steps; }, report).steps;
  }
  std::uint64_t step(std::uint64_t steps) {
    return step(steps, [] {});
  }

  /// `follower`: null for none.
  /// @throw Refusal while another is under way, std::invalid_argument for bad options.
  RelaxationResult relax(const RelaxationOptions& options, RelaxFollower* follower = nullptr);

  /// Ends a step or relaxation under way at its best state so far, at rest. Never waits for it, nor
  /// for a change of the scene.
  /// @return whether there was one.
  bool cancel();

  /// Ends a step or relaxation under way, and refuses every further one.
  void close();

  /// How things stand, to be measured at leisure without holding anything up.
  struct Snapshot {
    State state;  ///< of a relaxation under way, the best so far
    std::shared_ptr<const Plan> plan;
    std::shared_ptr<Account> account;
    StepChoice choice;  ///< of the last step, or of the next one
    double accuracy;    ///< that it was made for [rad/s]; 0: none
    bool running;
    Activity activity;
    double relax_progress;  ///< 0 to 1 while relaxing
    double step_wall_time;  ///< mean of a step lately [s]
    double stepped_time;    ///< of all steps so far, of earlier scenes too [s]
  };
  Snapshot snapshot();

  /// The scene with its particles where they are now: of a relaxation under way, the best so far.
  SceneFile present();

 private:
  class Busy;

  /// Lets go of what is prepared for further relaxations if a change alters the topology.
  class TopologyWatch {
   public:
    explicit TopologyWatch(Runner& runner)
        : runner_(runner), topology_(runner.simulation_.topology()) {}
    ~TopologyWatch() {
      if (runner_.simulation_.topology() != topology_) runner_.relaxations_.forget();
    }
    TopologyWatch(const TopologyWatch&) = delete;
    TopologyWatch& operator=(const TopologyWatch&) = delete;

   private:
    Runner& runner_;
    const std::uint64_t topology_;
  };

  void requireIdle() const;
  Activity activity() const;
  template <class Progress>
  void ask(Follower<Progress>* follower, const Progress& progress);
  void show(const std::shared_ptr<const RelaxationResult>& best, double fraction);
  void settle(const Points& positions);
  std::uint64_t stepForASlice(std::uint64_t most);

  FairMutex mutex_;  // guards the next three
  Simulation simulation_;
  double step_wall_time_ = 0;
  double stepped_time_ = 0;

  // Guards what follows, is locked after mutex_ where both are, and never held for long, so that a
  // cancel is answered while a large scene is changed. An activity begins under mutex_ too: what
  // holds mutex_ and finds none may go on.
  mutable std::mutex control_;
  bool running_;
  bool closed_ = false;
  Activity activity_ = Activity::none;
  std::shared_ptr<const RelaxationResult> shown_;  // null unless a relaxation has got somewhere
  double relax_progress_ = 0;

  std::atomic<bool> cancelled_{false};  // set under control_

  // Used by the one caller whose relaxation is under way, and by changes while there is none.
  CancellableRelaxer relaxations_;
};

}  // namespace spherical_springs::core
