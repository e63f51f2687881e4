// The error that steps of some length make, told from trial steps.
#pragma once

#include <memory>

#include "spherical_springs/integrator.h"

namespace spherical_springs::core {

/// Tries steps of a copy of a state over a window of a few periods of its fastest motion. A single
/// step tells too little: where particles turn back, an error of the velocity is none of the
/// position.
class ErrorProbe {
 public:
  /// `state` must live longer. `most_steps`: of a window that are tried.
  ErrorProbe(std::shared_ptr<const Plan> plan, const State& state, int most_steps);

  /// Returns the time in which the fastest motion changes much [s]: the longest step that `verlet`
  /// bears, or that in which the fastest particle turns by 2 rad; infinite where nothing moves.
  double fastestTime() const;

  /// Returns the longest step that a method bears here [s]; infinite where nothing bounds it.
  double stableTimeStep(IntegrationMethod method) const;

  /// Returns how many steps of `time_step` [s] are tried.
  int stepsTried(double time_step) const;

  /// Estimates the error [rad/s] of steps of `time_step` [s]: the largest distance, over particles
  /// and instants of the window, from where steps of half the length lead, by the length of the
  /// window, with Richardson's factor. Steps too short to be tried are judged by longer ones and
  /// the order of the method. Infinite where the steps lead to no numbers.
  /// @throw std::bad_alloc.
  double errorRate(IntegrationMethod method, double time_step) const;

 private:
  double largestDifference(IntegrationMethod method, double time_step, int steps) const;

  const std::shared_ptr<const Plan> plan_;
  const State& state_;
  const int most_steps_;
  const double highest_frequency_, highest_speed_;  // [rad/s]
};

}  // namespace spherical_springs::core
