// The topics of the node.
#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/timer.h>
#include <ros/wall_timer.h>
#include <spherical_springs/Energies.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <string>

#include "diagnostics.h"
#include "lag.h"
#include "parameters.h"
#include "rest.h"
#include "spherical_springs/runner.h"

namespace spherical_springs {

/// Publishes poses, energies, status and diagnostics. Nothing is computed for a topic that nobody
/// listens to, but for the status at a change, which is latched. A sample that cannot be made, for
/// want of memory, is left out; a status is tried again.
class Publisher {
 public:
  /// `sampling` and `reporting`: handles whose callbacks publish poses and energies, and status and
  /// diagnostics, each on one thread. `runner` must live longer.
  Publisher(ros::NodeHandle sampling, ros::NodeHandle reporting, core::Runner& runner,
            const Parameters& parameters);

  /// The status will be published soon: within a twentieth of a second, but for large scenes, whose
  /// status takes long to work out.
  void statusChanged() { status_changed_ = true; }

  /// Puts `message` into the status as the last thing worth telling a person.
  void tell(const std::string& message);

  Energies energies(const core::Runner::Snapshot& snapshot) const;

  Diagnostics& diagnostics() { return diagnostics_; }

 private:
  using Clock = std::chrono::steady_clock;

  void publishSample();
  void publishStatusIfDue();
  Report report(const core::Runner::Snapshot& snapshot);
  double realTimeFactor(const core::State& state);

  // Read-only.
  const Parameters parameters_;

  // Safe for many threads by themselves.
  core::Runner& runner_;
  std::atomic<bool> status_changed_{true};
  Diagnostics diagnostics_;

  // Used by the status timer alone.
  Clock::time_point last_status_ = Clock::now();
  Rest rest_;
  double last_simulated_ = 0;
  Lag lag_;
  core::Measures measures_;

  std::mutex mutex_;
  std::string message_;  // guarded by mutex_

  // Last, so that their callbacks end before what these use.
  ros::Publisher poses_, energies_, status_;
  ros::Timer sample_timer_;
  ros::WallTimer status_timer_;
};

}  // namespace spherical_springs
