// From where particles are to a minimum of the energy: descents, and the ways out of the places
// where they end without one.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "relaxation/newton.h"
#include "relaxation/orientation_guard.h"
#include "relaxation/torque_limit.h"
#include "spherical_springs/relaxation.h"

namespace spherical_springs::core {

/// One relaxation under way.
class MinimumSearch {
 public:
  /// All arguments are to outlive the search. `newton` is to fit the system; `at_start`: whether it
  /// is at `positions` already.
  MinimumSearch(const System& system, const Points& positions, const RelaxationOptions& options,
                Newton& newton, bool at_start);
  ~MinimumSearch();
  MinimumSearch(const MinimumSearch&) = delete;
  MinimumSearch& operator=(const MinimumSearch&) = delete;

  /// Searches, once.
  RelaxationResult run();

 private:
  using Clock = std::chrono::steady_clock;
  enum class Outcome { within_limit, stuck, ended };

  void descendToMinimum();
  Outcome descend();
  bool leaveSaddle();
  bool leaveUndefined(unsigned attempt);
  bool leaveFlat();
  bool isBelowFlat();
  void goBackToFlat();
  bool mayBeTheEnd() const;
  bool isBetter() const;
  void keep();
  void converge();
  bool goOn();
  double fraction() const;
  void giveUp();
  std::string torqueLeft() const;

  const System& system_;
  const RelaxationOptions& options_;
  const TorqueLimit limit_;
  const Clock::time_point begin_ = Clock::now();
  const Points& start_;
  std::vector<bool> calm_;  // at the start
  OrientationGuard guard_;
  Newton& newton_;
  std::unique_ptr<Descent> dynamics_;  // none for Newton's method
  Descent* descent_;
  double first_excess_;
  RelaxationResult result_;
  double excess_ = 0;  // of the result
  unsigned flat_attempts_ = 0;
  std::optional<Points> flat_;  // a minimum by its torque and curvature that was left, to be sure
};

}  // namespace spherical_springs::core
