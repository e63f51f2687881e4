#include "spherical_springs/runner.h"

#include <chrono>
#include <utility>

namespace spherical_springs::core {
namespace {

using Clock = std::chrono::steady_clock;
using Lock = std::lock_guard<FairMutex>;

constexpr std::chrono::milliseconds kSlice(2);       // of stepping between chances for others
constexpr std::chrono::milliseconds kShowEvery(20);  // what long work has come to

}  // namespace

/// Marks the runner as busy for its own lifetime.
class Runner::Busy {
 public:
  Busy(Runner& runner, Activity activity) : runner_(runner) {
    const Lock lock(runner_.mutex_);
    runner_.requireIdle();
    if (activity == Activity::stepping && runner_.running_) {
      throw std::runtime_error("the simulation is running; pause it first by ~set_running");
    }
    runner_.activity_ = activity;
    runner_.relax_progress_ = 0;
    runner_.cancelled_ = false;
  }
  ~Busy() {
    const Lock lock(runner_.mutex_);
    runner_.activity_ = Activity::none;
  }
  Busy(const Busy&) = delete;
  Busy& operator=(const Busy&) = delete;

 private:
  Runner& runner_;
};

void Runner::requireIdle() const {
  if (activity_ == Activity::none) return;
  const std::string what = activity_ == Activity::relaxing ? "~relax" : "~step";
  throw std::runtime_error("a " + what + " is under way; wait for it or end it by ~cancel");
}

void Runner::setRunning(bool running) {
  const Lock lock(mutex_);
  requireIdle();
  running_ = running;
}

std::uint64_t Runner::stepForASlice(std::uint64_t most) {
  const auto begin = Clock::now();
  std::uint64_t done = 0;
  Clock::duration taken;
  do {
    simulation_.step();
    taken = Clock::now() - begin;
  } while (++done < most && taken < kSlice);
  step_wall_time_ = std::chrono::duration<double>(taken).count() / done;
  return done;
}

std::uint64_t Runner::advance(std::uint64_t steps, double wall_time) {
  const auto end = Clock::now() + std::chrono::duration<double>(wall_time);
  std::uint64_t done = 0;
  while (done < steps && Clock::now() < end) {
    const Lock lock(mutex_);
    if (!running_ || activity_ != Activity::none) break;
    done += stepForASlice(steps - done);
  }
  return done;
}

std::uint64_t Runner::step(std::uint64_t steps) {
  const Busy busy(*this, Activity::stepping);
  std::uint64_t done = 0;
  while (done < steps && !cancelled_) {
    const Lock lock(mutex_);
    done += stepForASlice(steps - done);
  }
  if (cancelled_) {
    const Lock lock(mutex_);
    simulation_.settle(Points(simulation_.state().positions));
  }
  return done;
}

RelaxationResult Runner::relax(RelaxationOptions options) {
  const Busy busy(*this, Activity::relaxing);
  Snapshot start = snapshot();
  auto shown = Clock::now();
  options.go_on = [&](const RelaxationProgress& progress) {
    if (Clock::now() - shown >= kShowEvery) {
      const Lock lock(mutex_);
      simulation_.settle(progress.positions);
      relax_progress_ = progress.fraction;
      shown = Clock::now();
    }
    return !cancelled_;
  };
  try {
    RelaxationResult result = core::relax(*start.system, start.state.positions, options);
    const Lock lock(mutex_);
    simulation_.settle(result.positions);
    return result;
  } catch (...) {
    const Lock lock(mutex_);
    simulation_.restore(std::move(start.state), start.account);
    throw;
  }
}

bool Runner::cancel() {
  const Lock lock(mutex_);
  if (activity_ == Activity::none) return false;
  cancelled_ = true;
  return true;
}

Runner::Snapshot Runner::snapshot() {
  const Lock lock(mutex_);
  return {simulation_.state(), simulation_.system(), simulation_.account(), running_,
          activity_,           relax_progress_,      step_wall_time_};
}

}  // namespace spherical_springs::core
