// The topics of the node.
#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/timer.h>
#include <ros/wall_timer.h>
#include <spherical_springs/Energies.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <string>

#include "diagnostics.h"
#include "lag.h"
#include "parameters.h"
#include "spherical_springs/runner.h"

namespace spherical_springs {

/// Publishes poses, energies, status and diagnostics. Nothing is computed for a topic that nobody
/// listens to, but for the status at a change, which is latched.
class Publisher {
 public:
  /// `runner` must live longer.
  Publisher(ros::NodeHandle node, core::Runner& runner, const Parameters& parameters);

  /// The status will be published soon: within a twentieth of a second, but for large scenes, whose
  /// status takes long to work out.
  void statusChanged() { status_changed_ = true; }

  /// Puts `message` into the status as the last thing worth telling a person.
  void tell(const std::string& message);

  Energies energies(const core::Runner::Snapshot& snapshot) const;

  Diagnostics& diagnostics() { return diagnostics_; }

 private:
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
  ros::WallTime last_status_, next_status_;  // not to publish before the next
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
