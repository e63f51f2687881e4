// What the methods of relaxation have in common.
#pragma once

#include <string>

#include "tangent_energy.h"

namespace spherical_springs::core {

/// One way down the energy.
class Descent {
 public:
  virtual ~Descent() = default;

  /// One iteration; `energy` is left at its new positions.
  /// @return false when rounding lets the method go no further.
  virtual bool iterate(TangentEnergy& energy) = 0;

  /// Forgets what earlier iterations have taught, after a move that was not its own.
  virtual void restart() = 0;
};

}  // namespace spherical_springs::core
