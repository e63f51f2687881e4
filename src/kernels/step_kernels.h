// What a step computes, for several springs or particles at a time.
#pragma once

#include <cstddef>
#include <cstdint>

namespace spherical_springs::core {

/// Elements come in groups of so many, the last filled up with elements of no stiffness.
constexpr std::size_t kGroup = 8;
constexpr std::size_t kRowLength = 4;  ///< of a vector in memory: x, y, z and one not used

struct alignas(kRowLength * sizeof(double)) Row {
  double values[kRowLength];
};

/// A field of each element of a list.
struct SpringConstants {
  const double* rest;
  const double* stiffness;
};

/// A list of elements: arcs; or triangles with up to two of their edges as arcs, first to second
/// and second to third corner.
struct Elements {
  const std::uint32_t* ends[3];  ///< where rows of particles begin [doubles]
  SpringConstants springs[3];    ///< the arc; or the triangle and its arcs
  std::uint32_t count;           ///< a multiple of kGroup
};

/// Adds the forces of `elements` to rows of `forces`, for particles at rows of `positions`, but
/// for the elements that are hard, whose indices it puts into `hard`: arcs near 0 or pi, triangles
/// with a pair of corners nearly antipodal.
/// @return how many are hard.
using ForceKernel = std::uint32_t (*)(const Elements& elements, const double* positions,
                                      double* forces, std::uint32_t* hard);

/// Particles side by side, a multiple of kGroup.
struct Particles {
  const double* positions;  ///< rows
  double* moved;            ///< rows; may be those of `positions`
  double* velocities[3];    ///< of each component, an array
  const double* forces;     ///< rows
  const double* inverse_masses;
  std::uint32_t count;
};

/// What a kick over some time does to a particle with viscous damping: arrays over particles.
struct ViscousKick {
  const double* decay;     ///< factor of the velocity
  const double* gain;      ///< velocity a torque
  const double* taken[3];  ///< energy a velocity squared, a velocity times torque, a torque squared
};

/// Velocities under the forces for `duration` [s].
using KickKernel = void (*)(const Particles& particles, double duration);

/// The same with damping. @return the energy that it took out [J].
using ViscousKickKernel = double (*)(const Particles& particles, const ViscousKick& kick);

/// Moves particles at their velocities for `duration` [s].
using DriftKernel = void (*)(const Particles& particles, double duration);

struct StepKernels {
  ForceKernel arcs;
  ForceKernel triangles[3];  ///< with so many arcs
  KickKernel kick;
  ViscousKickKernel viscous_kick;
  DriftKernel drift;
};

/// Those for the widest instructions that this processor has.
const StepKernels& stepKernels();

}  // namespace spherical_springs::core
