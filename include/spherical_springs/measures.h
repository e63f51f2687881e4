// Energies, errors and bounds of a system.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "spherical_springs/integrator.h"
#include "spherical_springs/state.h"
#include "spherical_springs/system.h"

namespace spherical_springs::core {

/// Energies of a state.
struct Energies {
  PotentialEnergies by_kind;                              ///< [J]
  double kinetic = 0;                                     ///< [J]
  double dissipated = 0;                                  ///< since the account began [J]
  double potential() const { return by_kind.total(); }    ///< [J]
  double total() const { return kinetic + potential(); }  ///< [J], without `dissipated`
};

/// Sums the energies of all springs and particles.
Energies energies(const Plan& plan, const State& state);

/// Conditions and energies of the springs of one kind, in the order of their ids.
template <class Spring>
struct StrainsOf {
  std::vector<double> conditions;  ///< C of each spring [rad or sr]
  std::vector<double> energies;    ///< stiffness C^2 / 2 [J]
};

/// Conditions and energies of the springs of each kind.
using Strains = PerKind<StrainsOf>;

/// Returns the condition and the energy of every spring; `positions`: one unit vector a particle.
/// \snippet test_headers.cpp strains
Strains strains(const System& system, const Points& positions);

/// Conserved quantities when the account began, and their change since. For many threads.
class Account {
 public:
  /// Begins at a state.
  Account(const Plan& plan, const State& state);

  /// |total + dissipated - its value at the beginning| / the total at the beginning, which counts
  /// as at least what rounding makes of the stiffest spring.
  double energyError(const Energies& now) const;

  /// The share of the steps since the beginning that were divided.
  double dividedSteps(const Progress& now) const;

  /// |L - its value at the beginning| / the largest sum of |m omega| since; 0 in a scene that does
  /// not conserve it.
  double angularMomentumError(const System& system, const State& state);

 private:
  const double energy_, scale_;
  const Vector3 momentum_;
  const std::uint64_t first_step_;
  std::mutex mutex_;  // guards what follows
  double largest_momentum_;
};

/// How well a simulation keeps what it should keep, and what its step costs in accuracy.
/// \snippet test_headers.cpp measures
struct Measures {
  double stable_time_step = 0;  ///< the largest that the method bears here [s]; may be infinite
  double local_error = 0;       ///< of a step in the mean: error_rate times the time step [rad]
  double error_rate = 0;        ///< as errorRate() has it [rad/s]
  double energy_error = 0;      ///< as Account has it
  double angular_momentum_error = 0;  ///< as Account has it
  double norm_error = 0;              ///< max | |p| - 1 |
  double max_torque = 0;              ///< on a particle that is not pinned [N m]
  double divided_steps = 0;           ///< as Account has it
  double shortest_substep = 0;  ///< of these since the account began [s]; 0 where there is none
  bool blown_up = false;        ///< the energy is far from what it was when the account began
  std::string warning;          ///< what is wrong with the step, in words; empty when nothing is
};

/// Measures a state, and what a step of `time_step` [s] from there costs in accuracy.
Measures measure(const std::shared_ptr<const Plan>& plan, IntegrationMethod method,
                 double time_step, const State& state, Account& account);

/// Largest torque of the springs on a particle that is not pinned [N m].
double maxTorque(const Plan& plan, const State& state);

/// max | |p| - 1 |
double normError(const State& state);

/// The largest time step [s] that `method` bears here; infinite where nothing bounds it.
double stableTimeStep(const System& system, IntegrationMethod method, const Points& positions);

/// Estimates the error [rad/s] of steps of `time_step` [s] from `state` on: the largest distance,
/// over particles and the 3 to 5 periods of the fastest motion that follow, between where these
/// steps lead and where exact ones do, by the time that this takes.
/// @throw std::bad_alloc.
double errorRate(const std::shared_ptr<const Plan>& plan, IntegrationMethod method,
                 double time_step, const State& state);

}  // namespace spherical_springs::core
