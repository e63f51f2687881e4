#include "spherical_springs/runner.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <utility>

#include "spherical_springs/range.h"

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
    if (runner_.closed_) throw std::runtime_error("the node is shutting down");
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

// One step shows how many more there is time for.
std::uint64_t Runner::stepForASlice(std::uint64_t most) {
  using Seconds = std::chrono::duration<double>;
  const auto begin = Clock::now();
  std::uint64_t done = 0, steps = 1;
  double left;
  do {
    steps = std::min(steps, most - done);
    simulation_.step(steps);
    done += steps;
    const double taken = Seconds(Clock::now() - begin).count();
    step_wall_time_ = taken / done;
    left = Seconds(kSlice).count() - taken;
    steps = left > step_wall_time_ ? static_cast<std::uint64_t>(left / step_wall_time_) : 1;
  } while (done < most && left > 0);
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
  if (done < steps) {
    const Lock lock(mutex_);
    simulation_.settle(Points(simulation_.state().positions));
  }
  return done;
}

/// A relaxation on a thread of its own, which may be left to end by itself.
struct Runner::Work {
  std::mutex mutex;  // guards what follows
  std::condition_variable changed;
  RelaxationResult best;
  double fraction = 0;
  bool finished = false;
  bool abandoned = false;
  std::exception_ptr fault;

  void run(Relaxer& relaxer, const System& system, const Points& positions,
           RelaxationOptions options) {
    options.go_on = [this](const RelaxationProgress& progress) {
      const std::lock_guard<std::mutex> lock(mutex);
      best = progress.best;
      fraction = progress.fraction;
      return !abandoned;
    };
    try {
      RelaxationResult result = relaxer.relax(system, positions, options);
      const std::lock_guard<std::mutex> lock(mutex);
      best = std::move(result);
    } catch (...) {
      fault = std::current_exception();
    }
    const std::lock_guard<std::mutex> lock(mutex);
    finished = true;
    changed.notify_all();
  }
};

Runner::~Runner() {
  if (worker_.joinable()) worker_.join();
}

Runner::Beginning Runner::beginning() {
  const Lock lock(mutex_);
  return {simulation_.state(), simulation_.system(), simulation_.begunAccount()};
}

RelaxationResult Runner::relax(const RelaxationOptions& options) {
  const Busy busy(*this, Activity::relaxing);
  if (worker_.joinable()) worker_.join();  // one that was cancelled may not have ended yet
  auto [start, system, account] = beginning();
  const auto work = std::make_shared<Work>();
  worker_ = std::thread([this, work, system = system, positions = start.positions, options] {
    work->run(relaxer_, *system, positions, options);
  });

  std::unique_lock<std::mutex> lock(work->mutex);
  while (!work->finished && !cancelled_) {
    work->changed.wait_for(lock, kShowEvery);
    show(work->best, work->fraction);
  }
  if (work->fault) {
    const Lock simulation_lock(mutex_);
    simulation_.restore(std::move(start), account);
    std::rethrow_exception(work->fault);
  }
  RelaxationResult result = work->best;
  if (!work->finished) {
    work->abandoned = true;
    result.message = "cancelled; largest torque " + toText(result.max_torque) + " N m";
  }
  if (result.positions.cols() == 0) result.positions = start.positions;
  const Lock simulation_lock(mutex_);
  simulation_.settle(result.positions);
  return result;
}

void Runner::show(const RelaxationResult& best, double fraction) {
  if (best.positions.cols() == 0) return;
  const Lock lock(mutex_);
  simulation_.settle(best.positions);
  relax_progress_ = fraction;
}

bool Runner::cancel() {
  const Lock lock(mutex_);
  if (activity_ == Activity::none) return false;
  cancelled_ = true;
  return true;
}

void Runner::close() {
  const Lock lock(mutex_);
  closed_ = true;
  cancelled_ = true;
}

Runner::Snapshot Runner::snapshot() {
  const Lock lock(mutex_);
  return {simulation_.state(), simulation_.system(), simulation_.account(), running_,
          activity_,           relax_progress_,      step_wall_time_};
}

}  // namespace spherical_springs::core
