#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "spherical_springs/system.h"

namespace spherical_springs::core {

/// The largest torque that a relaxation leaves on a free particle: one bound for all [N m], or a
/// share of the stiffness that each particle feels, so that soft springs relax beside stiff ones.
class TorqueLimit {
 public:
  /// `bound`: [N m]; 0: 1e-9 of the stiffness or, where that is less, what rounding of the
  /// conditions of the springs at the particle makes of its torque.
  TorqueLimit(const System& system, double bound);

  bool isRelative() const { return bound_ == 0; }

  /// The bound for all particles, unless it is relative [N m].
  double bound() const { return bound_; }

  /// The bound on a particle that feels `stiffness` [N m/rad], by its index in the system.
  double allowed(std::size_t particle, double stiffness) const {
    constexpr double kShare = 1e-9;
    // Next to antipodal vertices a triangle is so stiff that all other torques would be allowed.
    constexpr double kStiffest = 1e5;  // of the springs' own
    if (!isRelative()) return bound_;
    const double counted = std::min(stiffness, kStiffest * own_stiffness_[particle]);
    // At least the sum of stiffness |gradient| over the springs, by Cauchy and Schwarz.
    const double torque_of_a_radian = std::sqrt(counted * own_stiffness_[particle]);
    return std::max(kShare * counted, kRounding * torque_of_a_radian);
  }

 private:
  static constexpr double kRounding = 1e-15;  // of an angle or a solid angle

  double bound_;
  Eigen::VectorXd own_stiffness_;  // of all springs at each particle; only where it is relative
};

/// The stiffness that each particle feels at `positions` [N m/rad]: half the trace of its block of
/// the definite Hessian, 0 where no spring acts on it.
Eigen::VectorXd feltStiffness(const System& system, const Points& positions);

/// The largest torque of the springs on a free particle at `positions` [N m].
double largestTorque(const System& system, const Points& positions);

/// The torque that `limit` allows on each particle at `positions` [N m].
Eigen::VectorXd allowedTorques(const System& system, const Points& positions,
                               const TorqueLimit& limit);

/// Tells which tolerance the torques at `positions` exceed, to go on a sentence: the bound for all,
/// or the particle that exceeds its own by the largest factor, if one does.
std::string excessInWords(const System& system, const Points& positions, const TorqueLimit& limit);

/// `torque` as a multiple of what is allowed, in one unit; above 1 where it is too large.
inline double excessOf(double torque, double allowed) { return torque == 0 ? 0 : torque / allowed; }

/// Returns for each particle whether its torque is allowed; true where it is pinned.
std::vector<bool> areWithin(const System& system, const Points& positions,
                            const TorqueLimit& limit);

}  // namespace spherical_springs::core
