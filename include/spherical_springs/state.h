#pragma once

#include <cstdint>

#include "spherical_springs/sphere.h"

namespace spherical_springs::core {

/// A passage of a spring by a place where its condition has no derivative, which took shorter steps
/// than the scene's.
struct Passage {
  double substep = 0;           ///< the shortest step of it [s]; 0: there was none
  double distance = 0;          ///< from the place: of a chord, or of an area [sr]
  const char* place = "";       ///< such as "antipodal vertices"
  const char* kind = "";        ///< of spring, as its `kName`
  std::uint32_t spring_id = 0;  ///< of its kind
  double time = 0;              ///< simulated, when the step began [s]
};

/// How far stepping has come.
struct Progress {
  double time = 0;                      ///< simulated [s]
  double time_rounding = 0;             ///< rounding error of `time`, kept by Kahan's summation [s]
  std::uint64_t steps = 0;              ///< since time was last 0
  std::uint64_t unconverged_steps = 0;  ///< of an implicit method, since the time was last 0
  double dissipated = 0;                ///< energy taken out by damping since the account began [J]
  std::uint64_t divided_steps = 0;      ///< with passages of springs, since the account began
  Passage shortest;                     ///< with the shortest step since the account began
};

/// Positions and velocities at a time. Columns are particles in the order of their ids.
/// \snippet test_headers.cpp state
struct State : Progress {
  Points positions;           ///< unit vectors
  Points angular_velocities;  ///< [rad/s], each normal to its position
};

/// Counts one step of `time_step` [s], with Kahan's summation of the time.
inline void countStep(double time_step, Progress& progress) {
  const double added = time_step - progress.time_rounding;
  const double sum = progress.time + added;
  progress.time_rounding = (sum - progress.time) - added;
  progress.time = sum;
  ++progress.steps;
}

}  // namespace spherical_springs::core
