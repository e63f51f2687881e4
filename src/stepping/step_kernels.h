// Kernels of a step, for several springs or particles at a time.
#pragma once

#include <cstdint>
#include <tuple>

#include "stepping/damping_kernels.h"
#include "stepping/row.h"

namespace spherical_springs::core {

/// Elements that a kernel takes together: arcs, or triangles with the arcs along their first edges.
/// The last group of a list is filled up with elements of no stiffness.
template <int kEnds, int kSprings>
struct alignas(Row) ElementGroup {
  static constexpr int kSpringsOfOne = kSprings;
  struct Springs {
    double rest[kGroup], stiffness[kGroup];
  };
  std::uint32_t ends[kEnds][kGroup];  ///< where rows of particles begin [doubles]
  Springs springs[kSprings];          ///< the arc; or the triangle, then its arcs
};

using Arcs = ElementGroup<2, 1>;
template <int kArcs>
using Triangles = ElementGroup<3, 1 + kArcs>;

/// Oriented arcs, as `OrientedAngleSpring` has them.
struct OrientedArcs : ElementGroup<3, 1> {
  double width[kGroup];  ///< in use; 0 for a sharp step
};

/// Indices of elements that a force kernel tells of, in lists with room for all elements.
struct MarkedElements {
  std::uint32_t* hard;  ///< arcs near 0 or pi, triangles with nearly antipodal corners, sharp steps
  std::uint32_t* near;  ///< others whose springs may be near a place where a condition has no
                        ///< derivative
  std::uint32_t hard_count = 0, near_count = 0;
};

/// Adds the forces of elements to rows of `forces`, for particles at rows of `positions`; what of a
/// force is along the position means nothing. Nothing is added for the elements that are hard.
template <class Group>
using ForceKernel = void (*)(const Group* groups, std::uint32_t group_count,
                             const double* positions, double* forces, MarkedElements& marked);

/// Energies of the first springs of elements, and of the arcs along the edges of triangles [J].
struct ElementEnergies {
  double first, arcs;
};

/// Adds the energies of those elements whose first end is at an offset below `limit`, but for the
/// hard ones among them.
/// @return how many are hard.
template <class Group>
using EnergyKernel = std::uint32_t (*)(const Group* groups, std::uint32_t group_count,
                                       const double* positions, std::uint32_t limit,
                                       ElementEnergies& energies, std::uint32_t* hard);

/// The flow of viscous damping over a kick, as in Damping::ViscousFlow: arrays over particles.
struct ViscousKick {
  const double* decay;
  const double* gain;
  const double* taken[3];
};

/// Velocities under the forces for `duration` [s].
using KickKernel = void (*)(const Particles& particles, double duration);

/// Kicks particles with viscous damping.
/// @return the energy that the damping took out [J].
using ViscousKickKernel = double (*)(const Particles& particles, const ViscousKick& kick);

/// Moves particles at their velocities for `duration` [s].
using DriftKernel = void (*)(const Particles& particles, double duration);

struct StepKernels {
  std::tuple<ForceKernel<Arcs>, ForceKernel<Triangles<0>>, ForceKernel<Triangles<1>>,
             ForceKernel<Triangles<2>>, ForceKernel<OrientedArcs>>
      forces;
  std::tuple<EnergyKernel<Arcs>, EnergyKernel<Triangles<0>>, EnergyKernel<Triangles<1>>,
             EnergyKernel<Triangles<2>>, EnergyKernel<OrientedArcs>>
      energies;
  KickKernel kick;
  ViscousKickKernel viscous_kick;
  DriftKernel drift;
  DampingKernels damping;  ///< of springs
};

/// The kernels for the widest instructions that this processor has.
const StepKernels& stepKernels();

}  // namespace spherical_springs::core
