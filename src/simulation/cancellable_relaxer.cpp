#include "simulation/cancellable_relaxer.h"

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <utility>

#include "relaxation/freedom.h"
#include "relaxation/torque_limit.h"
#include "relaxation/turn_back.h"
#include "spherical_springs/range.h"

namespace spherical_springs::core {
namespace {

constexpr std::chrono::milliseconds kWatchEvery(20);

}  // namespace

struct CancellableRelaxer::Work {
  Work(std::shared_ptr<const System> system, Points start, const RelaxationOptions& options)
      : system(std::move(system)), start(std::move(start)), options(options) {}

  const std::shared_ptr<const System> system;
  const Points start;
  RelaxationOptions options;

  std::mutex mutex;  // guards what follows
  std::condition_variable changed;
  std::shared_ptr<const RelaxationResult> best;  // null before the first iteration
  double fraction = 0;
  RelaxationResult result;  // once finished without a fault
  bool finished = false;
  bool abandoned = false;
  std::exception_ptr fault;

  void run(Relaxer& relaxer) {
    options.go_on = [this](const RelaxationProgress& progress) {
      auto copy = std::make_shared<const RelaxationResult>(progress.best);
      const std::lock_guard<std::mutex> lock(mutex);
      best.swap(copy);
      fraction = progress.fraction;
      return !abandoned;
    };
    RelaxationResult found;
    std::exception_ptr thrown;
    try {
      found = relaxer.relax(*system, start, options);
    } catch (...) {
      thrown = std::current_exception();
    }
    const std::lock_guard<std::mutex> lock(mutex);
    result = std::move(found);
    fault = thrown;
    finished = true;
    changed.notify_all();
  }

  /// Waits until it has finished.
  /// @return false where `watch`, which may take its time, cancels first.
  bool await(const Watch& watch) {
    std::unique_lock<std::mutex> lock(mutex);
    while (!finished) {
      const auto reached = best;
      const double reached_fraction = fraction;
      lock.unlock();
      if (!watch(reached, reached_fraction)) return false;
      lock.lock();
      if (!finished) changed.wait_for(lock, kWatchEvery);
    }
    return true;
  }

  bool isFinished() {
    const std::lock_guard<std::mutex> lock(mutex);
    return finished;
  }

  void abandon() {
    const std::lock_guard<std::mutex> lock(mutex);
    abandoned = true;
  }

  /// The answer of a relaxation that was cancelled when it had come to `reached`; null: nowhere.
  RelaxationResult cancelled(const std::shared_ptr<const RelaxationResult>& reached) const {
    RelaxationResult answer = reached ? *reached : unrelaxed(*system, start);
    const TorqueLimit limit(*system, options.tolerance);
    turnBack(*system, start, areWithin(*system, start, limit), answer);
    judge(*system, answer);
    answer.message = "cancelled; largest torque " + toText(answer.max_torque) + " N m";
    return answer;
  }
};

CancellableRelaxer::~CancellableRelaxer() {
  if (thread_.joinable()) thread_.join();
}

/// Waits for the thread of a relaxation that was cancelled.
/// @return false where `watch` cancels first.
bool CancellableRelaxer::awaitLast(const Watch& watch) {
  if (!thread_.joinable()) return true;
  if (!last_->await([&](const auto&, double) { return watch(nullptr, 0); })) return false;
  thread_.join();
  last_.reset();
  return true;
}

void CancellableRelaxer::forget() {
  if (!thread_.joinable()) relaxer_.forget();
}

CancellableRelaxer::Outcome CancellableRelaxer::relax(std::shared_ptr<const System> system,
                                                      Points start,
                                                      const RelaxationOptions& options,
                                                      const Watch& watch) {
  const auto work = std::make_shared<Work>(std::move(system), std::move(start), options);
  if (!awaitLast(watch)) return {work->cancelled(nullptr), true};
  last_ = work;
  thread_ = std::thread([this, work] { work->run(relaxer_); });
  Outcome outcome;
  try {
    outcome = await(*work, watch);
  } catch (...) {
    work->abandon();
    throw;
  }
  if (work->isFinished()) awaitLast(watch);
  return outcome;
}

CancellableRelaxer::Outcome CancellableRelaxer::await(Work& work, const Watch& watch) {
  work.await(watch);
  std::unique_lock<std::mutex> lock(work.mutex);
  if (work.fault) std::rethrow_exception(work.fault);
  if (work.finished) return {std::move(work.result), false};
  work.abandoned = true;
  const auto reached = work.best;
  lock.unlock();
  return {work.cancelled(reached), true};
}

}  // namespace spherical_springs::core
