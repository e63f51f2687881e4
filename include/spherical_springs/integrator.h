// Stepping through time by compositions of exact flows.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "spherical_springs/state.h"
#include "spherical_springs/system.h"

namespace spherical_springs::core {

/// A step as a composition of exact flows: drift[0], kick[0], drift[1], kick[1], ..., drift.back(),
/// each over its share of the time step. A drift moves particles on great circles at constant
/// angular velocity; a kick turns the springs' torques into angular velocity, between two halves of
/// the flow of damping at the same positions.
struct SplittingScheme {
  std::string name;
  int order;
  std::vector<double> drift, kick;
};

/// `euler`: the report's step (section 5), speed first, then position from the new speed: first
/// order, symplectic. `verlet`: Strang's splitting, second order.
/// @throw std::invalid_argument for any other name.
const SplittingScheme& splittingScheme(const std::string& name);

class Integrator {
 public:
  /// `time_step`: [s], above 0.
  Integrator(std::shared_ptr<const System> system, const SplittingScheme& scheme, double time_step);

  /// One step of exactly `time_step`. A function of the state alone, so that the same steps give
  /// the same bits however they are cut into calls.
  void step(State& state);

 private:
  void drift(double duration, State& state) const;
  void kick(double duration, State& state);

  std::shared_ptr<const System> system_;
  const SplittingScheme& scheme_;
  double time_step_;
  System::Workspace workspace_;
};

}  // namespace spherical_springs::core
