// The motion of particles in step_kernels.h, for whatever level of instruction set a file that
// includes this is compiled for.
#pragma once

#include <math.h>

#include "stepping/damping_lanes.h"
#include "stepping/energy_lanes.h"
#include "stepping/particle_lanes.h"
#include "stepping/rows.h"
#include "stepping/step_lanes.h"

namespace {

using spherical_springs::core::Particles;
using spherical_springs::core::ViscousKick;

void kick(const Particles& particles, double duration) {
  for (std::uint32_t first = 0; first < particles.count; first += kLanes) {
    const Lanes3 torque = cross(loadRows(particles.positions + kRowLength * first),
                                loadRows(particles.forces + kRowLength * first));
    const Lanes gain = duration * load(particles.inverse_masses + first);
    storeVelocities(loadVelocities(particles, first) + gain * torque, particles, first);
  }
}

double viscousKick(const Particles& particles, const ViscousKick& kick) {
  Lanes taken = {};
  for (std::uint32_t first = 0; first < particles.count; first += kLanes) {
    const Lanes3 torque = cross(loadRows(particles.positions + kRowLength * first),
                                loadRows(particles.forces + kRowLength * first));
    const Lanes3 velocity = loadVelocities(particles, first);
    taken += load(kick.taken[0] + first) * dot(velocity, velocity) +
             load(kick.taken[1] + first) * dot(velocity, torque) +
             load(kick.taken[2] + first) * dot(torque, torque);
    storeVelocities(load(kick.decay + first) * velocity + load(kick.gain + first) * torque,
                    particles, first);
  }
  return sum(taken);
}

struct LaneTurn {
  Lanes cosine, sinc;
};

/// Returns what `turnBy` in src/geometry/sphere.cpp does, with fewer terms where all angles are
/// below 0.03.
inline LaneTurn turnBy(const Lanes& squared_angle) {
  constexpr double kSmall = 0.25, kTiny = 1e-3;
  constexpr double kCosine[] = {1,          -1. / 2,       1. / 24,        -1. / 720,
                                1. / 40320, -1. / 3628800, 1. / 479001600, -1. / 87178291200};
  constexpr double kSinc[] = {1,           -1. / 6,        1. / 120,        -1. / 5040,
                              1. / 362880, -1. / 39916800, 1. / 6227020800, -1. / 1307674368000};
  constexpr double kTinyCosine[] = {kCosine[0], kCosine[1], kCosine[2], kCosine[3], kCosine[4]};
  constexpr double kTinySinc[] = {kSinc[0], kSinc[1], kSinc[2], kSinc[3]};
  if (!any(squared_angle > kTiny)) {
    return {polynomial(kTinyCosine, squared_angle), polynomial(kTinySinc, squared_angle)};
  }
  LaneTurn turn = {polynomial(kCosine, squared_angle), polynomial(kSinc, squared_angle)};
  for (int k = 0; k < kLanes; ++k) {
    if (!(squared_angle[k] > kSmall)) continue;
    const double angle = ::sqrt(squared_angle[k]);
    turn.cosine[k] = ::cos(angle);
    turn.sinc[k] = ::sin(angle) / angle;
  }
  return turn;
}

void drift(const Particles& particles, double duration) {
  for (std::uint32_t first = 0; first < particles.count; first += kLanes) {
    const Lanes3 position = loadRows(particles.positions + kRowLength * first);
    const Lanes3 velocity = loadVelocities(particles, first);
    const Lanes3 rotation = duration * velocity;
    const Lanes squared_angle = dot(rotation, rotation);
    const LaneTurn turn = turnBy(squared_angle);
    Lanes3 moved = turn.cosine * position + turn.sinc * cross(rotation, position);
    // Rounding alone has put a part along the position, and the length off 1.
    storeVelocities(velocity - dot(moved, velocity) * moved, particles, first);
    moved = (1.5 - 0.5 * dot(moved, moved)) * moved;
    storeRows(select(squared_angle == 0, position, moved), particles.moved + kRowLength * first);
  }
}

}  // namespace

namespace spherical_springs::core {

/// This file's own.
static constexpr StepKernels kKernels = {
    {addAll<ShortArcs>, addAll<ShortTriangles<0>>, addAll<ShortTriangles<1>>,
     addAll<ShortTriangles<2>>, addAll<NoShortWay<OrientedArcs>>},
    {addEnergies<Arcs, 1>, addEnergies<Triangles<0>, 1>, addEnergies<Triangles<1>, 2>,
     addEnergies<Triangles<2>, 3>, addEnergies<OrientedArcs, 1>},
    kick,
    viscousKick,
    drift,
    kDampingKernels};

}  // namespace spherical_springs::core
