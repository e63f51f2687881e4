#include "stepping/damped_kick.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.h"
#include "stepping/exact_springs.h"

namespace spherical_springs::core {

namespace {

/// The largest number of places for dampers of one kind in a patch.
std::uint32_t mostDampers(const DamperLayout& dampers) {
  std::uint32_t most = 0;
  for (const auto& share : dampers.shares()) {
    forEachKind([&](auto kind) {
      const GroupRange& range = share.template get<typename decltype(kind)::type>().groups;
      most = std::max(most, range.end - range.begin);
    });
  }
  return most * static_cast<std::uint32_t>(kGroup);
}

}  // namespace

DampedKick::DampedKick(const System& system, const Layout& layout, const DampingKernels& kernels,
                       int threads)
    : system_(system),
      layout_(layout),
      kernels_(kernels),
      threads_(threads),
      own_(system.springDamping() == SpringDamping::own),
      dampers_(system, layout),
      sweep_(dampers_, gradients_, kernels, own_),
      viscous_(layout.slotCount(), 0),
      torques_(layout.slotCount(), Row{}),
      last_(layout.rowCount(), Row{}),
      next_(last_),
      rates_(layout.patches().size(), 0),
      dissipated_(layout.patches().size(), 0),
      scratches_(layout, mostDampers(dampers_), threads) {
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    gradients_.get<Spring>().resize(dampers_.groups().get<Spring>().size());
  });
  for (const Patch& patch : layout.patches()) {
    for (std::uint32_t i = 0; i < patch.particle_count; ++i) {
      const std::uint32_t particle = layout.order()[patch.first_place + i];
      viscous_[patch.first_slot + i] = system.damping().viscous(particle);
    }
  }
}

namespace {

AngleSpring springOf(const ArcDampers&, std::uint32_t) { return {}; }
SolidAngleSpring springOf(const TriangleDampers&, std::uint32_t) { return {}; }
OrientedAngleSpring springOf(const OrientedArcDampers& group, std::uint32_t lane) {
  OrientedAngleSpring spring;
  spring.width = widthOfSpring(group.width[lane]);
  return spring;
}

template <class Spring>
const Spring& springOf(const PlainDampers<Spring>& group, std::uint32_t lane) {
  return group.springs[lane];
}

template <class Dampers>
void takeExactly(const Dampers& group, std::uint32_t lane, const Row* positions,
                 GradientsOf<Dampers>& gradients) {
  const auto points = pointsAt(rowsOf<Dampers::kEnds>(group, lane), positions);
  const auto exact = condition(springOf(group, lane), points).gradient;
  for (int i = 0; i < Dampers::kEnds - 1; ++i) {
    const Vector3 gradient = group.root_coefficient[lane] * exact[i];
    for (int k = 0; k < 3; ++k) gradients.of[i][k][lane] = gradient[k];
  }
}

}  // namespace

void DampedKick::takeGradients(std::size_t patch, const Row* positions) {
  const Patch& here = layout_.patches()[patch];
  const auto scratch = scratches_.lease(here);
  double* const bounds = scratch->sums[0].values;
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    const auto [begin, end] = dampers_.shares()[patch].get<Spring>().groups;
    if (begin == end) return;
    const auto& kernels = damperKernels<Spring>(kernels_);
    const auto* const groups = dampers_.groups().get<Spring>().data() + begin;
    auto* const gradients = gradients_.get<Spring>().data() + begin;
    const std::uint32_t hard_count =
        kernels.gradients(groups, end - begin, positions->values, gradients, scratch->hard.data());
    for (std::uint32_t h = 0; h < hard_count; ++h) {
      const std::uint32_t group = scratch->hard[h] / kGroup;
      takeExactly(groups[group], scratch->hard[h] % kGroup, positions, gradients[group]);
    }
    kernels.add_bounds(groups, gradients, end - begin, own_, bounds);
  });
  double fastest = 0;
  for (std::uint32_t i = 0; i < here.particle_count; ++i) {
    const std::uint32_t particle = layout_.order()[here.first_place + i];
    const double viscous = viscous_[here.first_slot + i] * system_.inverseMasses()[particle];
    fastest = std::max(fastest, viscous + scratch->sums[i].values[0]);
  }
  rates_[patch] = fastest;
}

void DampedKick::takeTorques(std::size_t patch, const Particles& particles) {
  const Patch& here = layout_.patches()[patch];
  kernels_.torques(particles, torques_[here.first_slot].values, last_[here.first_row].values);
}

double DampedKick::fastestRate() const { return *std::max_element(rates_.begin(), rates_.end()); }

void DampedKick::prepare(double duration) {
  sweep_.makeRoom();
  const Damping& damping = system_.damping();
  if (damping.hasViscous()) viscous_flows_.prepare(duration / 4, damping, layout_);
}

double DampedKick::kick(double duration, const Velocities& velocities) {
  const double decays = fastestRate() * std::abs(duration);
  if (Damping::takenBySeries(decays)) {
    return kickBySeries(duration, Damping::seriesTerms(decays), velocities);
  }
  return duration < 0 ? kickByTorques(duration, velocities) : kickBySweeps(duration, velocities);
}

double DampedKick::kickByTorques(double duration, const Velocities& velocities) {
  return sumOverPatches([&](std::size_t patch) {
    applyTorques(layout_.patches()[patch], duration, velocities.inverse_masses);
    giveVelocities(layout_.patches()[patch], velocities);
    return 0.;
  });
}

template <class Work>
double DampedKick::sumOverPatches(const Work& work) {
  forOnThreads(layout_.patches().size(), threads_, [&](std::ptrdiff_t patch) {
    if (layout_.patches()[patch].particle_count > 0) dissipated_[patch] = work(patch);
  });
  double sum = 0;
  for (const double of_patch : dissipated_) sum += of_patch;
  return sum;
}

double DampedKick::kickBySeries(double duration, int terms, const Velocities& velocities) {
  double taken = 0;
  for (int n = 1; n <= terms; ++n) {
    const SeriesTerm term = n == 1 ? SeriesTerm{duration, -duration, 0}
                                   : SeriesTerm{0, -duration / n, duration / (n + 1)};
    taken += sumOverPatches([&](std::size_t patch) { return addTerm(patch, term, velocities); });
    last_.swap(next_);
  }
  return taken;
}

double DampedKick::addTerm(std::size_t patch, const SeriesTerm& term,
                           const Velocities& velocities) {
  const Patch& here = layout_.patches()[patch];
  layout_.updateGhosts(here, last_);
  const auto scratch = scratches_.lease(here);
  const double* const last = last_[here.first_row].values;
  double* const rates = scratch->sums[0].values;
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    const auto [begin, end] = dampers_.shares()[patch].get<Spring>().groups;
    const auto& kernels = damperKernels<Spring>(kernels_);
    kernels.add_rates(dampers_.groups().get<Spring>().data() + begin,
                      gradients_.get<Spring>().data() + begin, end - begin, own_, last, rates);
  });
  const std::uint32_t slot = here.first_slot;
  const DampedParticles particles = {
      {velocities.components[0] + slot, velocities.components[1] + slot,
       velocities.components[2] + slot},
      velocities.inverse_masses + slot,
      &viscous_[slot],
      torques_[slot].values,
      here.slotCount()};
  return kernels_.series(particles, term, last, rates, next_[here.first_row].values);
}

// Each half of the damping goes over all dampers and back, and the torques act in the middle. Those
// within patches share no particles with those of other patches, so that their order does not
// matter.
double DampedKick::kickBySweeps(double duration, const Velocities& velocities) {
  const double quarter = duration / 4;
  const ViscousFlow* const viscous =
      system_.damping().hasViscous() ? &viscous_flows_.over(quarter) : nullptr;
  double taken = sumOverPatches([&](std::size_t patch) {
    sweep_.takeFlows(patch, quarter);
    return sweepThere(patch, viscous);
  });
  taken += sweep_.shared(last_.data());
  taken += sumOverPatches([&](std::size_t patch) {
    const double before = sweepBack(patch, viscous);
    applyTorques(layout_.patches()[patch], duration, velocities.inverse_masses);
    return before + sweepThere(patch, viscous);
  });
  taken += sweep_.shared(last_.data());
  return taken + sumOverPatches([&](std::size_t patch) {
           const double after = sweepBack(patch, viscous);
           giveVelocities(layout_.patches()[patch], velocities);
           return after;
         });
}

double DampedKick::sweepThere(std::size_t patch, const ViscousFlow* viscous) {
  const Patch& here = layout_.patches()[patch];
  const double taken = dampViscously(here, viscous);
  return taken + sweep_.innerForward(patch, &last_[here.first_row]);
}

double DampedKick::sweepBack(std::size_t patch, const ViscousFlow* viscous) {
  const Patch& here = layout_.patches()[patch];
  const double taken = sweep_.innerBackward(patch, &last_[here.first_row]);
  return taken + dampViscously(here, viscous);
}

double DampedKick::dampViscously(const Patch& patch, const ViscousFlow* viscous) {
  if (viscous == nullptr) return 0;
  double taken = 0;
  for (std::uint32_t i = 0; i < patch.particle_count; ++i) {
    Eigen::Map<Vector3> velocity(last_[patch.first_row + i].values);
    taken += viscous->taken[0][patch.first_slot + i] * velocity.squaredNorm();
    velocity *= viscous->decay[patch.first_slot + i];
  }
  return taken;
}

void DampedKick::applyTorques(const Patch& patch, double duration, const double* inverse_masses) {
  for (std::uint32_t i = 0; i < patch.particle_count; ++i) {
    const std::uint32_t slot = patch.first_slot + i;
    Eigen::Map<Vector3>(last_[patch.first_row + i].values) +=
        duration * inverse_masses[slot] * Eigen::Map<const Vector3>(torques_[slot].values);
  }
}

/// Little may be left of them beside the rounding of what they were, which is in any direction.
void DampedKick::giveVelocities(const Patch& patch, const Velocities& velocities) const {
  for (std::uint32_t i = 0; i < patch.particle_count; ++i) {
    const std::uint32_t row = patch.first_row + i;
    const Vector3 tangent = tangentPart(Eigen::Map<const Vector3>(velocities.positions[row].values),
                                        Eigen::Map<const Vector3>(last_[row].values));
    for (int k = 0; k < 3; ++k) velocities.components[k][patch.first_slot + i] = tangent[k];
  }
}

}  // namespace spherical_springs::core
