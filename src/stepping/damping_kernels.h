// Kernels for damped springs, several springs or particles at a time.
//
// Velocities and rates lie in rows, as positions do.
#pragma once

#include <tuple>

#include "stepping/row.h"

namespace spherical_springs::core {

/// Damped springs that a kernel takes together. The last group of a list is filled up with ones of
/// no damping.
template <int kEndsOfOne>
struct alignas(kCacheLine) DamperGroup {
  static constexpr int kEnds = kEndsOfOne;

  double root_coefficient[kGroup];
  double root_mobility[kEnds][kGroup];  ///< of each end, the root of its particle's inverse mass
  std::uint32_t ends[kEnds][kGroup];    ///< where rows of particles begin [doubles]
};

struct ArcDampers : DamperGroup<2> {};
struct TriangleDampers : DamperGroup<3> {};
struct OrientedArcDampers : DamperGroup<3> {
  double width[kGroup];  ///< of the change of sign, 0 for a sharp step
};

/// Gradients of the conditions of a group's springs, as `Condition` has them, times the root of the
/// coefficient. They are 0 in sum, as a rotation of the whole changes no condition, and those of
/// the last ends are left out.
template <int kEnds>
struct alignas(kCacheLine) GradientGroup {
  double of[kEnds - 1][3][kGroup];
};
template <class Dampers>
using GradientsOf = GradientGroup<Dampers::kEnds>;

/// The flow of a damper over a duration: the change of momentum per rate, and the energy taken out
/// per squared rate.
struct DamperFlow {
  double impulse, energy;
};

/// Dampers of a patch that act one after another.
template <class Dampers>
struct DamperChain {
  const Dampers* dampers;
  const GradientsOf<Dampers>* gradients;
  const DamperFlow* flows;  ///< one a damper, or one an end
  std::uint32_t group_count;
  std::uint32_t count;  ///< of those that act; the n-th is in lane n / group_count
};

/// Kernels for one kind of springs; `own` is whether dampers act on the ends each by itself.
template <class Dampers>
struct DamperKernels {
  /// Gradients for particles at rows of `positions`. Indices of springs that are hard are put into
  /// `hard`, and their gradients mean nothing. @return how many are hard.
  std::uint32_t (*gradients)(const Dampers* dampers, std::uint32_t group_count,
                             const double* positions, GradientsOf<Dampers>* gradients,
                             std::uint32_t* hard);

  /// Adds to the first number of the rows of `bounds` what Gershgorin's circles of M^-1 D have.
  void (*add_bounds)(const Dampers* dampers, const GradientsOf<Dampers>* gradients,
                     std::uint32_t group_count, bool own, double* bounds);

  /// Adds D velocities to the rows of `rates`.
  void (*add_rates)(const Dampers* dampers, const GradientsOf<Dampers>* gradients,
                    std::uint32_t group_count, bool own, const double* velocities, double* rates);

  /// Lets dampers act on the rows of `velocities` group by group, or in the opposite order.
  /// @return the energy that they took out [J].
  double (*forward)(const DamperChain<Dampers>& chain, bool own, double* velocities);
  double (*backward)(const DamperChain<Dampers>& chain, bool own, double* velocities);
};

/// Particles side by side, a multiple of kGroup, under torques and damping.
struct DampedParticles {
  double* velocities[3];  ///< of each component, an array
  const double* inverse_masses;
  const double* viscous;  ///< coefficients
  const double* torques;  ///< rows
  std::uint32_t count;
};

/// A term of Taylor's series of the velocities in time.
struct SeriesTerm {
  double torque_gain;   ///< the first: the duration; others: 0
  double damping_gain;  ///< -duration / number of the term
  double path;          ///< of its integral: duration / (number + 1); the first: 0
};

/// Adds a term to the velocities and puts it into the rows of `next`; `last` is the one before, the
/// velocities themselves before the first, and `rates` what springs make of it.
/// @return the energy that damping took out with it [J].
using SeriesKernel = double (*)(const DampedParticles& particles, const SeriesTerm& term,
                                const double* last, const double* rates, double* next);

/// Puts the torques of forces into rows of `torques`, and the velocities into rows of `start`.
using TorqueKernel = void (*)(const Particles& particles, double* torques, double* start);

struct DampingKernels {
  std::tuple<DamperKernels<ArcDampers>, DamperKernels<TriangleDampers>,
             DamperKernels<OrientedArcDampers>>
      springs;
  SeriesKernel series;
  TorqueKernel torques;
};

}  // namespace spherical_springs::core
