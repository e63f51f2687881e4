// The topics of the node.
#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/steady_timer.h>
#include <ros/timer.h>
#include <spherical_springs/Energies.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>

#include "node/diagnostics.h"
#include "node/news.h"
#include "node/parameters.h"
#include "node/real_time_monitor.h"
#include "node/rest.h"
#include "simulation/runner.h"

namespace spherical_springs {

/// Publishes poses, energies, status and diagnostics. Nothing is computed for a topic that nobody
/// listens to, but for the status at a change, which is latched. A sample that cannot be made, for
/// want of memory, is left out; a status is tried again.
class Publisher {
 public:
  /// `sampling` and `reporting`: handles whose callbacks publish poses and energies, and status and
  /// diagnostics, each on one thread. The arguments must live longer.
  Publisher(ros::NodeHandle sampling, ros::NodeHandle reporting, core::Runner& runner, News& news,
            const Parameters& parameters);

  /// Begins a new period of poses and energies; for one thread at a time. `rate`: [Hz].
  void setRate(double rate);

  /// Judges from now on whether simulated time follows the clock by this factor. For any thread.
  void expectRealTimeFactor(double factor) { expected_factor_ = factor; }

 private:
  using Clock = std::chrono::steady_clock;

  void publishSample();
  void publishSampleIfMissing();
  void publishStatusIfDue();
  void tellOfChoice(const core::Runner::Snapshot& snapshot);
  Report report(const core::Runner::Snapshot& snapshot);
  double realTimeFactor(double stepped_time);

  // Read-only.
  const Parameters parameters_;

  // Safe for many threads by themselves.
  core::Runner& runner_;
  News& news_;
  std::atomic<double> expected_factor_;
  std::atomic<double> sample_period_;  // [s]

  // Used by the callbacks of `sampling` alone.
  Clock::time_point last_sample_ = Clock::now();
  std::uint64_t sampled_changes_ = 0;

  // Used by the status timer alone.
  Diagnostics diagnostics_;
  Clock::time_point last_status_ = Clock::now();
  Rest rest_;
  double last_stepped_time_ = 0;
  RealTimeMonitor real_time_monitor_;
  core::Measures measures_;
  core::StepChoice told_;
  double told_accuracy_ = 0;  // [rad/s]
  std::string told_words_;

  // Last, so that their callbacks end before what these use.
  ros::Publisher poses_, energies_, status_;
  ros::Timer sample_timer_;
  ros::SteadyTimer missing_sample_timer_, status_timer_;
};

}  // namespace spherical_springs
