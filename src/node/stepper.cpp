#include "node/stepper.h"

#include <algorithm>

#include "node/elapsed.h"
#include "node/faults.h"

namespace spherical_springs {
namespace {

using WallClock = std::chrono::steady_clock;

constexpr double kPeriod = 0.01;  // [s]

}  // namespace

Stepper::Stepper(const ros::NodeHandle& node, core::Runner& runner, const Parameters& parameters)
    : runner_(runner),
      last_step_(ros::Time::now()),
      last_wall_step_(WallClock::now()),
      step_clock_(parameters.real_time_factor),
      timer_(node.createTimer(ros::Duration(kPeriod),
                              loggingFaults("a tick is left out", [this] { tick(); }))),
      thread_([this] { stepAtEachTick(); }) {}

Stepper::~Stepper() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ends_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void Stepper::setPace(const Pace& pace) {
  const std::lock_guard<std::mutex> lock(mutex_);
  step_clock_.change(pace.time_step, pace.real_time_factor);
}

void Stepper::tick() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ticked_ = true;
  }
  changed_.notify_one();
}

void Stepper::stepAtEachTick() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return ticked_ || ends_; });
    if (ends_) return;
    ticked_ = false;
    lock.unlock();
    runLoggingFaults("steps are left out", [this] { step(); });
    lock.lock();
  }
}

// Steps that do not fit into the time until the next tick are dropped: simulated time falls behind.
void Stepper::step() {
  const ros::Time now = ros::Time::now();
  const auto wall_now = WallClock::now();
  // Under use_sim_time the clock is zero until its first message; that it then begins somewhere is
  // no time gone by.
  const double elapsed = last_step_.isZero() ? 0 : secondsBetween(last_step_, now);
  const double wall_elapsed = std::chrono::duration<double>(wall_now - last_wall_step_).count();
  last_step_ = now;
  last_wall_step_ = wall_now;
  const auto [left, time_step] =
      runner_.advance(dueAfter(elapsed), std::max(kPeriod, wall_elapsed));
  const std::lock_guard<std::mutex> lock(mutex_);
  step_clock_.keep(left, time_step);
}

double Stepper::dueAfter(double elapsed) {
  const std::lock_guard<std::mutex> lock(mutex_);
  return step_clock_.due(elapsed);
}

}  // namespace spherical_springs
