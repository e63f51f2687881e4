// Viscous damping of all particles over a kick, in the order of a layout.
#pragma once

#include <vector>

#include "spherical_springs/damping.h"
#include "stepping/layout.h"

namespace spherical_springs::core {

/// `Damping::viscousFlow` of each particle over some duration, in arrays over slots.
struct ViscousFlow {
  double duration;  ///< [s]
  std::vector<double> decay, gain, taken[3];
};

/// The flows over the few durations that a scheme has.
class ViscousFlows {
 public:
  void prepare(double duration, const Damping& damping, const Layout& layout);

  /// The flow over a duration that has been prepared.
  const ViscousFlow& over(double duration) const;

 private:
  std::vector<ViscousFlow> known_;
};

}  // namespace spherical_springs::core
