#pragma once

#include <vector>

#include "spherical_springs/integrator.h"

namespace spherical_springs::core {

/// A step as a composition of exact flows: drift[0], kick[0], drift[1], kick[1], ..., drift.back(),
/// each over its share of the time step. A drift moves particles on great circles at constant
/// angular velocity; a kick lets torques and damping change the angular velocities where the
/// particles are.
struct SplittingScheme {
  int order;
  double stability_limit;  ///< of frequency times step
  std::vector<double> drift, kick;
};

const SplittingScheme& splittingScheme(IntegrationMethod method);

/// The scheme to take in place of `scheme` where damping of up to `fastest_rate` [1/s] decays
/// within a step.
const SplittingScheme& schemeUnderDamping(const SplittingScheme& scheme, double fastest_rate,
                                          double time_step);

}  // namespace spherical_springs::core
