#include "simulation/runner.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace spherical_springs::core {
namespace {

using Clock = std::chrono::steady_clock;
using Lock = std::lock_guard<FairMutex>;
using ControlLock = std::lock_guard<std::mutex>;

constexpr std::chrono::milliseconds kSlice(2);  // of stepping between chances for others

}  // namespace

/// Marks the runner as busy for its own lifetime.
class Runner::Busy {
 public:
  Busy(Runner& runner, Activity activity) : runner_(runner) {
    const Lock lock(runner_.mutex_);
    runner_.requireIdle();
    const ControlLock control(runner_.control_);
    if (runner_.closed_) throw Refusal(Refusal::Reason::closed, "the runner is closed");
    if (activity == Activity::stepping && runner_.running_) {
      throw Refusal(Refusal::Reason::running, "the simulation is running");
    }
    runner_.activity_ = activity;
    runner_.relax_progress_ = 0;
    runner_.cancelled_ = false;
  }
  ~Busy() {
    const ControlLock control(runner_.control_);
    runner_.activity_ = Activity::none;
    runner_.shown_.reset();
  }
  Busy(const Busy&) = delete;
  Busy& operator=(const Busy&) = delete;

 private:
  Runner& runner_;
};

Activity Runner::activity() const {
  const ControlLock control(control_);
  return activity_;
}

void Runner::requireIdle() const {
  const Activity now = activity();
  if (now == Activity::relaxing) {
    throw Refusal(Refusal::Reason::relaxing, "a relaxation is under way");
  }
  if (now == Activity::stepping) {
    throw Refusal(Refusal::Reason::stepping, "a step is under way");
  }
}

void Runner::setRunning(bool running) {
  const Lock lock(mutex_);
  requireIdle();
  const ControlLock control(control_);
  running_ = running;
}

bool Runner::isRunning() const {
  const ControlLock control(control_);
  return running_;
}

StepChoice Runner::stepBy(const StepWish& wish, std::optional<bool> running) {
  const Lock lock(mutex_);
  const bool wish_changes = !wish.asksTheSameAs(simulation_.settings());
  const bool running_changes = running && *running != isRunning();
  if (running_changes || (wish_changes && activity() == Activity::stepping)) requireIdle();
  if (wish_changes) simulation_.stepBy(wish);
  if (running_changes) {
    const ControlLock control(control_);
    running_ = *running;
  }
  return simulation_.lastChoice();
}

StepChoice Runner::choice() {
  const Lock lock(mutex_);
  return activity() == Activity::relaxing ? simulation_.lastChoice() : simulation_.choice();
}

// One step shows how many more there is time for.
std::uint64_t Runner::stepForASlice(std::uint64_t most) {
  using Seconds = std::chrono::duration<double>;
  constexpr double kShortest = 1e-9;  // what a clock may round to 0 [s]
  const auto begin = Clock::now();
  std::uint64_t done = 0, steps = 1;
  double left;
  do {
    steps = std::min(steps, most - done);
    simulation_.step(steps);
    done += steps;
    const double taken = Seconds(Clock::now() - begin).count();
    stepped_time_ += static_cast<double>(steps) * simulation_.lastChoice().time_step;
    step_wall_time_ = std::max(taken / done, kShortest);
    left = Seconds(kSlice).count() - taken;
    steps = left > step_wall_time_ ? static_cast<std::uint64_t>(left / step_wall_time_) : 1;
  } while (done < most && left > 0);
  return done;
}

namespace {

/// Returns how many steps fit into a duration [s], but for what rounding makes of it.
std::uint64_t wholeSteps(double duration, double time_step) {
  constexpr double kMost = 1e15, kRounding = 1e-9;
  return static_cast<std::uint64_t>(std::clamp(duration / time_step + kRounding, 0., kMost));
}

}  // namespace

Runner::Left Runner::advance(double duration, double wall_time) {
  const auto end = Clock::now() + std::chrono::duration<double>(wall_time);
  const auto mayStep = [&] {
    const ControlLock control(control_);
    return running_ && activity_ == Activity::none;
  };
  double time_step = 0;
  do {
    const Lock lock(mutex_);
    time_step = simulation_.lastChoice().time_step;
    if (!mayStep()) break;
    const StepChoice& choice = simulation_.choice();
    time_step = choice.time_step;
    const std::uint64_t steps = wholeSteps(duration, time_step);
    if (steps == 0) break;
    const std::uint64_t done = stepForASlice(std::min(steps, choice.steps_to_review));
    duration -= static_cast<double>(done) * time_step;
  } while (Clock::now() < end);
  return {duration, time_step};
}

/// Lets the follower of the work under way cancel it.
template <class Progress>
void Runner::ask(Follower<Progress>* follower, const Progress& progress) {
  if (follower != nullptr && !follower->goesOn(progress)) cancel();
}

Runner::Done Runner::step(const StepCount& count, const std::function<void()>& report,
                          StepFollower* follower) {
  const Busy busy(*this, Activity::stepping);
  Simulation::Moment before = read([](Simulation& s) { return s.moment(); });
  const double begin = before.state.time;
  Done done;
  try {
    double time_step = 0;  // by which the steps were counted
    std::uint64_t steps = 0;
    while (true) {
      ask(follower, {done.steps, begin + done.time});
      const Lock lock(mutex_);
      const StepChoice& choice = simulation_.choice();
      if (choice.time_step != time_step) steps = count(time_step = choice.time_step, done);
      if (steps == 0) break;
      if (cancelled_) {
        if (follower != nullptr) follower->cancelled();
        simulation_.settle(Points(simulation_.state().positions));
        break;
      }
      const std::uint64_t part = stepForASlice(std::min(steps, choice.steps_to_review));
      done.steps += part;
      done.time += static_cast<double>(part) * time_step;
      steps -= part;
    }
    report();
  } catch (...) {
    const Lock lock(mutex_);
    simulation_.restore(std::move(before));
    throw;
  }
  return done;
}

RelaxationResult Runner::relax(const RelaxationOptions& options, RelaxFollower* follower) {
  requireValid(options);
  const Busy busy(*this, Activity::relaxing);
  ask(follower, {nullptr, 0});
  auto [system, start] = read([](Simulation& simulation) {
    return std::pair(simulation.plan()->system(), simulation.state().positions);
  });
  const auto watch = [&](const std::shared_ptr<const RelaxationResult>& best, double fraction) {
    show(best, fraction);
    ask(follower, {best.get(), fraction});
    return !cancelled_;
  };
  auto [result, cancelled] =
      relaxations_.relax(std::move(system), std::move(start), options, watch);
  if (cancelled && follower != nullptr) follower->cancelled();
  settle(result.positions);
  return std::move(result);
}

void Runner::show(const std::shared_ptr<const RelaxationResult>& best, double fraction) {
  const ControlLock control(control_);
  shown_ = best;
  relax_progress_ = fraction;
}

/// Ends what a relaxation shows as well, so that nothing older is seen after it.
void Runner::settle(const Points& positions) {
  const Lock lock(mutex_);
  simulation_.settle(positions);
  const ControlLock control(control_);
  shown_.reset();
}

bool Runner::cancel() {
  const ControlLock control(control_);
  if (activity_ == Activity::none) return false;
  cancelled_ = true;
  return true;
}

void Runner::close() {
  const ControlLock control(control_);
  closed_ = true;
  cancelled_ = true;
}

Runner::Snapshot Runner::snapshot() {
  Snapshot now;
  std::uint64_t revision;
  std::shared_ptr<const RelaxationResult> shown;
  {
    const Lock lock(mutex_);
    now.state = simulation_.state();
    now.plan = simulation_.plan();
    now.account = simulation_.begunAccount();
    now.choice = simulation_.lastChoice();
    now.accuracy = simulation_.settings().accuracy;
    now.step_wall_time = step_wall_time_;
    now.stepped_time = stepped_time_;
    revision = simulation_.revision();
    const ControlLock control(control_);
    now.running = running_;
    now.activity = activity_;
    now.relax_progress = relax_progress_;
    shown = shown_;
  }
  if (shown) {
    now.state.positions = shown->positions;
    now.state.angular_velocities.setZero();
    now.state.dissipated = 0;
  }
  // Summing the energy of all springs may take long.
  if (!now.account) {
    now.account = std::make_shared<Account>(*now.plan, now.state);
    if (!shown) {
      const Lock lock(mutex_);
      now.account = simulation_.begin(now.account, revision);
    }
  }
  return now;
}

SceneFile Runner::present() {
  SceneFile now;
  std::shared_ptr<const RelaxationResult> shown;
  {
    const Lock lock(mutex_);
    now.scene = simulation_.presentScene();
    now.time = simulation_.state().time;
    const ControlLock control(control_);
    shown = shown_;
  }
  if (shown) now.scene.place(shown->positions, Points::Zero(3, shown->positions.cols()));
  return now;
}

}  // namespace spherical_springs::core
