#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <spherical_springs/Status.h>

#include <mutex>
#include <string>

namespace spherical_springs {

/// What there is to report at one moment.
struct Report {
  Status status;
  std::string warning;    ///< what is wrong with the steps; empty when nothing is
  bool blown_up = false;  ///< the energy is far from what it should be
  bool behind = false;    ///< simulated time falls behind the clock
};

/// The node's part of /diagnostics: OK, WARN or ERROR, and the figures of Status.
class Diagnostics {
 public:
  explicit Diagnostics(ros::NodeHandle node);

  bool listenedTo() const { return listeners_.getNumSubscribers() > 0; }
  void publish(const Report& report);

  /// A request was refused for a number that is not finite: an error, for ten seconds.
  void refused(const std::string& reason);

  /// How the last ~relax ended: `fault` says why it did not converge, and is empty if it did, or if
  /// nothing is left of where it came to.
  void relaxed(const std::string& fault);

 private:
  void fill(diagnostic_updater::DiagnosticStatusWrapper& wrapper);

  Report report_;  // used by publish and what it calls alone

  std::mutex mutex_;  // guards what follows
  std::string refusal_, relaxation_fault_;
  ros::WallTime refused_at_;
  unsigned refusals_ = 0;

  diagnostic_updater::Updater updater_;
  ros::Publisher listeners_;  // on the updater's topic, which does not say who listens
};

}  // namespace spherical_springs
