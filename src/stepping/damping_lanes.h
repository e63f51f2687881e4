// The kernels of damping_kernels.h, for whatever level of instruction set a file that includes this
// is compiled for.
#pragma once

#include "stepping/damping_kernels.h"
#include "stepping/particle_lanes.h"
#include "stepping/step_batch.h"

namespace {

using spherical_springs::core::ArcDampers;
using spherical_springs::core::DampedParticles;
using spherical_springs::core::DamperChain;
using spherical_springs::core::DamperFlow;
using spherical_springs::core::GradientGroup;
using spherical_springs::core::GradientsOf;
using spherical_springs::core::OrientedArcDampers;
using spherical_springs::core::Particles;
using spherical_springs::core::SeriesTerm;
using spherical_springs::core::TriangleDampers;

/// Gradients at the ends of springs, but for the last.
template <int kEnds>
struct LaneGradients {
  Lanes3 of[kEnds - 1];

  Lanes3 at(int end) const {
    if (end < kEnds - 1) return of[end];
    Lanes3 sum = of[0];
    for (int i = 1; i < kEnds - 1; ++i) sum = sum + of[i];
    return negative(sum);
  }
};

/// Gradients, and a mask of the lanes in which they are not sound.
template <int kEnds>
struct FreshGradients : LaneGradients<kEnds> {
  LaneMask hard;
};

template <class Formula, int kEnds>
[[gnu::always_inline]] inline void takeGradients(const Formula& formula,
                                                 FreshGradients<kEnds>& gradients) {
  formula.gradients(gradients.of);
  gradients.hard = formula.hard;
}

FreshGradients<2> gradientsOf(const Batch<ArcDampers>& batch, const double* positions) {
  FreshGradients<2> gradients;
  takeGradients(AngleLanes(batch.gather(0, positions), batch.gather(1, positions)), gradients);
  return gradients;
}

FreshGradients<3> gradientsOf(const Batch<TriangleDampers>& batch, const double* positions) {
  FreshGradients<3> gradients;
  takeGradients(SolidAngleLanes(batch.gather(0, positions), batch.gather(1, positions),
                                batch.gather(2, positions)),
                gradients);
  return gradients;
}

FreshGradients<3> gradientsOf(const Batch<OrientedArcDampers>& batch, const double* positions) {
  FreshGradients<3> gradients;
  takeGradients(OrientedAngleLanes(batch.gather(0, positions), batch.gather(1, positions),
                                   batch.gather(2, positions), batch.lanes(batch.group->width)),
                gradients);
  return gradients;
}

template <class Dampers>
std::uint32_t gradients(const Dampers* dampers, std::uint32_t group_count, const double* positions,
                        GradientsOf<Dampers>* result, std::uint32_t* hard) {
  std::uint32_t hard_count = 0;
  for (std::uint32_t g = 0; g < group_count; ++g) {
    for (std::uint32_t first = 0; first < kGroup; first += kLanes) {
      const auto lanes = gradientsOf(Batch<Dampers>{dampers + g, first}, positions);
      const Lanes root_coefficient = load(dampers[g].root_coefficient + first);
      for (int i = 0; i < Dampers::kEnds - 1; ++i) {
        const Lanes3 gradient = root_coefficient * lanes.of[i];
        store(gradient.x, result[g].of[i][0] + first);
        store(gradient.y, result[g].of[i][1] + first);
        store(gradient.z, result[g].of[i][2] + first);
      }
      for (int k = 0; k < kLanes; ++k) {
        if (lanes.hard[k] != 0) hard[hard_count++] = g * kGroup + first + k;
      }
    }
  }
  return hard_count;
}

template <int kEnds>
[[gnu::always_inline]] inline LaneGradients<kEnds> loadGradients(
    const GradientGroup<kEnds>& gradients, std::uint32_t first) {
  LaneGradients<kEnds> lanes;
  for (int i = 0; i < kEnds - 1; ++i) {
    const auto& from = gradients.of[i];
    lanes.of[i] = {load(from[0] + first), load(from[1] + first), load(from[2] + first)};
  }
  return lanes;
}

/// Calls `use(batch, gradients)`, some springs at a time.
template <class Dampers, class Use>
[[gnu::always_inline]] inline void forEachBatch(const Dampers* dampers,
                                                const GradientsOf<Dampers>* gradients,
                                                std::uint32_t group_count, const Use& use) {
  for (std::uint32_t g = 0; g < group_count; ++g) {
    for (std::uint32_t first = 0; first < kGroup; first += kLanes) {
      use(Batch<Dampers>{dampers + g, first}, loadGradients(gradients[g], first));
    }
  }
}

template <class Dampers>
void addBounds(const Dampers* dampers, const GradientsOf<Dampers>* gradients,
               std::uint32_t group_count, bool own, double* bounds) {
  constexpr int kEnds = Dampers::kEnds;
  forEachBatch(dampers, gradients, group_count, [&](const auto& batch, const auto& lanes) {
    Lanes levers[kEnds], sum = {};
    for (int i = 0; i < kEnds; ++i) {
      const Lanes3 gradient = lanes.at(i);
      levers[i] =
          squareRoot(dot(gradient, gradient)) * load(batch.group->root_mobility[i] + batch.first);
      sum += levers[i];
    }
    for (int i = 0; i < kEnds; ++i) {
      const Lanes bound = levers[i] * (own ? levers[i] : sum);
      for (int k = 0; k < kLanes; ++k) bounds[batch.rows(i)[k]] += bound[k];
    }
  });
}

template <class Dampers>
void addRatesOfEnds(const Dampers* dampers, const GradientsOf<Dampers>* gradients,
                    std::uint32_t group_count, const double* velocities, double* rates) {
  forEachBatch(dampers, gradients, group_count, [&](const auto& batch, const auto& lanes) {
    for (int i = 0; i < Dampers::kEnds; ++i) {
      const Lanes3 gradient = lanes.at(i);
      addRows(dot(gradient, batch.gather(i, velocities)) * gradient, rates, batch.rows(i));
    }
  });
}

/// Adds to the rows of all ends but the last, and takes the sum from those of the last.
template <class Dampers>
[[gnu::always_inline]] inline void addBalanced(const Batch<Dampers>& batch,
                                               const Lanes3 (&rates)[Dampers::kEnds - 1],
                                               double* to) {
  constexpr int kLast = Dampers::kEnds - 1;
  Four sums[kLanes] = {};
  for (int i = 0; i < kLast; ++i) {
    forEachRow(rates[i], [&](int k, const Four& row) {
      addFour(row, to + batch.rows(i)[k]);
      sums[k] -= row;
    });
  }
  for (int k = 0; k < kLanes; ++k) addFour(sums[k], to + batch.rows(kLast)[k]);
}

template <class Dampers>
void addRatesOfSprings(const Dampers* dampers, const GradientsOf<Dampers>* gradients,
                       std::uint32_t group_count, const double* velocities, double* rates) {
  constexpr int kLast = Dampers::kEnds - 1;
  forEachBatch(dampers, gradients, group_count, [&](const auto& batch, const auto& lanes) {
    const std::uint32_t* const base = batch.rows(kLast);
    Lanes rate = {};
    for (int i = 0; i < kLast; ++i) {
      rate += dot(lanes.of[i], gatherDifferences(velocities, batch.rows(i), base));
    }
    Lanes3 shares[kLast];
    for (int i = 0; i < kLast; ++i) shares[i] = rate * lanes.of[i];
    addBalanced(batch, shares, rates);
  });
}

template <class Dampers>
void addRates(const Dampers* dampers, const GradientsOf<Dampers>* gradients,
              std::uint32_t group_count, bool own, const double* velocities, double* rates) {
  const auto add = own ? addRatesOfEnds<Dampers> : addRatesOfSprings<Dampers>;
  add(dampers, gradients, group_count, velocities, rates);
}

/// Vectors in the first three numbers.
inline double sumOf(const Four& v) { return v[0] + v[1] + v[2]; }

/// One damper and its ends.
template <int kEnds>
struct DamperRows {
  Four gradients[kEnds];
  double mobilities[kEnds];
  double* velocities[kEnds];

  /// Pushes an end by a share of its gradient.
  [[gnu::always_inline]] void push(int end, double momentum) const {
    addFour(momentum * mobilities[end] * gradients[end], velocities[end]);
  }
  [[gnu::always_inline]] Four rate(int end) const {
    return gradients[end] * loadFour(velocities[end]);
  }

  [[gnu::always_inline]] double dampTogether(const DamperFlow& flow) const {
    Four rates = rate(0);
    for (int i = 1; i < kEnds; ++i) rates += rate(i);
    const double whole = sumOf(rates);
    for (int i = 0; i < kEnds; ++i) push(i, flow.impulse * whole);
    return flow.energy * whole * whole;
  }

  [[gnu::always_inline]] double dampEach(const DamperFlow* flows) const {
    double taken = 0;
    for (int i = 0; i < kEnds; ++i) {
      const double own = sumOf(rate(i));
      push(i, flows[i].impulse * own);
      taken += flows[i].energy * own * own;
    }
    return taken;
  }
};

template <class Dampers, int kEnds>
[[gnu::always_inline]] inline void takeRows(const Batch<Dampers>& batch,
                                            const LaneGradients<kEnds>& gradients,
                                            double* velocities, DamperRows<kEnds> (&rows)[kLanes]) {
  for (int end = 0; end < kEnds; ++end) {
    forEachRow(gradients.at(end), [&](int k, const Four& row) { rows[k].gradients[end] = row; });
    for (int k = 0; k < kLanes; ++k) {
      const double root = batch.group->root_mobility[end][batch.first + k];
      rows[k].mobilities[end] = root * root;
      rows[k].velocities[end] = velocities + batch.rows(end)[k];
    }
  }
}

template <class Dampers, bool kOwn, bool kBackward>
double dampInTurn(const DamperChain<Dampers>& chain, double* velocities) {
  constexpr int kEnds = Dampers::kEnds;
  const auto turn = [](std::uint32_t i, std::uint32_t count) {
    return kBackward ? count - 1 - i : i;
  };
  double taken = 0;
  for (std::uint32_t i = 0; i < chain.group_count; ++i) {
    const std::uint32_t g = turn(i, chain.group_count);
    for (std::uint32_t j = 0; j < kGroup / kLanes; ++j) {
      const std::uint32_t first = kLanes * turn(j, kGroup / kLanes);
      DamperRows<kEnds> rows[kLanes];
      takeRows(Batch<Dampers>{chain.dampers + g, first}, loadGradients(chain.gradients[g], first),
               velocities, rows);
      for (int n = 0; n < kLanes; ++n) {
        const std::uint32_t k = turn(n, kLanes), lane = first + k;
        if (lane * chain.group_count + g >= chain.count) continue;
        const std::uint32_t damper = g * kGroup + lane;
        taken += kOwn ? rows[k].dampEach(chain.flows + kEnds * damper)
                      : rows[k].dampTogether(chain.flows[damper]);
      }
    }
  }
  return taken;
}

template <class Dampers, bool kBackward>
double dampAll(const DamperChain<Dampers>& chain, bool own, double* velocities) {
  const auto damp =
      own ? dampInTurn<Dampers, true, kBackward> : dampInTurn<Dampers, false, kBackward>;
  return damp(chain, velocities);
}

// The energy that a term takes out is the work of the torques on its path less the gain of kinetic
// energy. In the first term the torques' share of both is equal and is left out of both.
double addSeriesTerm(const DampedParticles& particles, const SeriesTerm& term, const double* last,
                     const double* rates, double* next) {
  Lanes taken = {};
  for (std::uint32_t first = 0; first < particles.count; first += kLanes) {
    const std::size_t row = kRowLength * first;
    const Lanes3 torque = loadRows(particles.torques + row);
    const Lanes3 impulse =
        term.damping_gain *
        (loadRows(rates + row) + load(particles.viscous + first) * loadRows(last + row));
    const Lanes3 change =
        load(particles.inverse_masses + first) * (impulse + term.torque_gain * torque);
    const Lanes3 velocity = loadVelocities(particles, first);
    storeVelocities(velocity + change, particles, first);
    storeRows(change, next + row);
    taken += term.path * dot(torque, change) - dot(impulse, velocity + 0.5 * change);
  }
  return sum(taken);
}

void torques(const Particles& particles, double* torques, double* start) {
  for (std::uint32_t first = 0; first < particles.count; first += kLanes) {
    const std::size_t row = kRowLength * first;
    storeRows(cross(loadRows(particles.positions + row), loadRows(particles.forces + row)),
              torques + row);
    storeRows(loadVelocities(particles, first), start + row);
  }
}

template <class Dampers>
constexpr spherical_springs::core::DamperKernels<Dampers> kDamperKernels = {
    gradients<Dampers>, addBounds<Dampers>, addRates<Dampers>, dampAll<Dampers, false>,
    dampAll<Dampers, true>};

constexpr spherical_springs::core::DampingKernels kDampingKernels = {
    {kDamperKernels<ArcDampers>, kDamperKernels<TriangleDampers>,
     kDamperKernels<OrientedArcDampers>},
    addSeriesTerm,
    torques};

}  // namespace
