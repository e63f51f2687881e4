// The interface of a method of relaxation.
#pragma once

#include "spherical_springs/sphere.h"

namespace spherical_springs::core {

/// The share of an energy, a sum over all springs, below which differences are rounding.
inline constexpr double kEnergyRounding = 1e-13;

/// One way down the energy.
class Descent {
 public:
  virtual ~Descent() = default;

  /// Starts from somewhere, with nothing remembered of the way before.
  virtual void place(const Points& positions) = 0;

  /// One iteration.
  /// @return false when the method gets no further.
  virtual bool iterate() = 0;

  /// Says what has ended a descent that gets no further, for a message.
  virtual const char* whyStuck() const = 0;

  virtual Points positions() const = 0;  ///< of all particles, in the order of their ids
  virtual double value() const = 0;      ///< energy [J]
  virtual double maxTorque() const = 0;  ///< on a free particle [N m]

  /// The largest torque on a free particle as a multiple of what the limit allows there.
  virtual double excess() const = 0;
};

}  // namespace spherical_springs::core
