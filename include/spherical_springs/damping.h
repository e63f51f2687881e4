// Damping of particles and of springs, and its flow together with constant torques.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "spherical_springs/sphere.h"

namespace spherical_springs::core {

/// Torques that are linear in the velocities while positions stand still:
/// M d omega / dt = tau - D omega, with D = viscous coefficients + sum of c g g^T over dampers.
class Damping {
 public:
  /// A damper on the rate sum of g . omega over some ends of springs.
  struct Damper {
    std::uint32_t first_end;  ///< place in the list of gradients g, which has one an end
    std::uint32_t end_count;  ///< of successive ends
    double coefficient;       ///< c [N m s/rad]
  };

  Damping() = default;  ///< none
  /// `inverse_masses`: [1/kg], one a particle, 0 where pinned. `viscous`: [N m s/rad], one a
  /// particle. `end_particles`: the particle of each end of a spring.
  Damping(const Values& inverse_masses, const Values& viscous, std::vector<Damper> dampers,
          std::vector<std::uint32_t> end_particles);

  /// Whether neither particles nor springs are damped.
  bool none() const { return !viscous_any_ && dampers_.empty(); }
  bool hasViscous() const { return viscous_any_; }       ///< whether any particle is damped
  bool hasDampers() const { return !dampers_.empty(); }  ///< whether any spring is damped
  double viscous(Eigen::Index particle) const { return viscous_[particle]; }  ///< [N m s/rad]

  /// The exact flow of viscous damping on one particle over a kick.
  struct ViscousFlow {
    double decay;                 ///< factor of the velocity
    double gain;                  ///< [rad/s] by [N m]
    std::array<double, 3> taken;  ///< energy [J] by w . w, w . torque and torque . torque
  };

  /// Returns the flow of the particle at an index over `duration` [s], which may be negative.
  ViscousFlow viscousFlow(Eigen::Index particle, double duration) const;

  /// A bound of the fastest decay [1/s], by Gershgorin's circles of M^-1 D. `gradients`: p x grad C
  /// at each end of each spring; not read where no spring is damped.
  double fastestRate(const std::vector<Vector3>& gradients) const;

  /// Whether the Taylor series is used: true if `decays`, the fastest rate times the duration, is
  /// at most 1.
  static bool takenBySeries(double decays) { return decays <= 1; }

  /// Number of terms of the Taylor series beyond the constant, until all others are below rounding.
  static int seriesTerms(double decays);

  /// Takes `velocities` [rad/s] over `duration` [s], which may be negative, under `torques` [N m]
  /// and the damping, at `positions` and their `gradients`; points and vectors have one column a
  /// particle. Where the damping is slow against the duration this is the exact flow, to rounding;
  /// where it is fast, a composition of second order that is stable for any coefficient. Back in
  /// time that would grow without bound: torques act alone there.
  /// @return the energy that damping took out [J].
  double kick(const Points& positions, const std::vector<Vector3>& gradients, const Points& torques,
              double duration, Points& velocities) const;

 private:
  void addRate(const std::vector<Vector3>& gradients, const Points& velocities, double factor,
               Points& sum) const;
  double kickBySeries(const std::vector<Vector3>& gradients, const Points& torques, double duration,
                      int terms, Points& velocities) const;
  double sweep(const std::vector<Vector3>& gradients, double duration, Points& velocities) const;
  double dampViscously(double duration, Points& velocities) const;
  double dampEnds(const Damper& damper, const std::vector<Vector3>& gradients, double duration,
                  Points& velocities) const;

  Values inverse_masses_, viscous_;
  bool viscous_any_ = false;
  std::vector<Damper> dampers_;
  std::vector<std::uint32_t> end_particles_;
};

}  // namespace spherical_springs::core
