// Invariants that hold after any input.
#pragma once

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "spherical_springs/measures.h"
#include "spherical_springs/simulation.h"

namespace spherical_springs::core::fuzzing {

/// Ends the run where `condition` does not hold.
inline void require(bool condition, const char* what) {
  if (condition) return;
  std::fprintf(stderr, "not so: %s\n", what);
  std::abort();
}

inline void requireUnitVectors(const Points& positions) {
  constexpr double kNormTolerance = 1e-12;
  require(positions.allFinite(), "positions are finite");
  for (Eigen::Index i = 0; i < positions.cols(); ++i) {
    require(std::abs(positions.col(i).norm() - 1) < kNormTolerance, "positions are unit vectors");
  }
}

inline void requireSound(Simulation& simulation) {
  const State& state = simulation.state();
  requireUnitVectors(state.positions);
  require(state.angular_velocities.allFinite(), "angular velocities are finite");
  require(std::isfinite(state.time), "time is finite");
  const Energies now = energies(*simulation.plan(), state);
  require(std::isfinite(now.total()), "energies are finite");
  require(std::isfinite(now.dissipated), "the energy taken out is finite");
}

/// Also of what ~status shows.
inline void requireSoundMeasures(Simulation& simulation) {
  const StepChoice choice = simulation.choice();
  const Measures measures = measure(simulation.plan(), choice.method, choice.time_step,
                                    simulation.state(), *simulation.account());
  require(!std::isnan(measures.stable_time_step), "the stable time step is a number");
  for (const double value :
       {measures.local_error, measures.energy_error, measures.angular_momentum_error,
        measures.norm_error, measures.max_torque}) {
    require(std::isfinite(value), "measures are finite");
  }
}

}  // namespace spherical_springs::core::fuzzing
