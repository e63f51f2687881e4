#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <spherical_springs/Status.h>

#include <string>

#include "node/news.h"

namespace spherical_springs {

inline constexpr auto kWaitsForClock =
    "waiting for /clock: /use_sim_time is true, and nobody has published a time yet";

/// Facts to report at one moment.
struct Report {
  Status status;
  News::Facts news;
  std::string warning;           ///< what is wrong with the steps; empty when nothing is
  bool blown_up = false;         ///< the energy is far from what it should be
  bool waits_for_clock = false;  ///< time is to be simulated, and has not begun
  bool behind = false;           ///< simulated time falls behind the clock
};

/// The node's part of /diagnostics: OK, WARN or ERROR, and the figures of Status. For one thread.
class Diagnostics {
 public:
  explicit Diagnostics(ros::NodeHandle node);

  bool listenedTo() const { return listeners_.getNumSubscribers() > 0; }
  void publish(const Report& report);

 private:
  void fill(diagnostic_updater::DiagnosticStatusWrapper& wrapper);

  const Report* report_ = nullptr;  // while it is published
  diagnostic_updater::Updater updater_;
  ros::Publisher listeners_;  // on the updater's topic, which does not say who listens
};

}  // namespace spherical_springs
