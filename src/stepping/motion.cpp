#include "stepping/motion.h"

#include <algorithm>
#include <utility>

#include "base/parallel.h"
#include "stepping/exact_springs.h"

namespace spherical_springs::core {

Motion::Motion(std::shared_ptr<const Plan> plan, const StepKernels& kernels)
    : plan_(std::move(plan)),
      system_(*plan_->system()),
      layout_(plan_->layout()),
      kernels_(kernels),
      forces_(layout_, kernels),
      threads_(layout_.patches().size() > 1 ? system_.threads() : 1),
      scratches_(layout_, mostElements(layout_), threads_),
      near_(layout_.patches().size()),
      rows_(layout_.order().size()),
      slots_(layout_.order().size()),
      positions_(layout_.rowCount(), Row{{1, 0, 0, 0}}),
      moved_(positions_),
      inverse_masses_(layout_.slotCount(), 0) {
  for (auto& component : velocities_) component.assign(layout_.slotCount(), 0);
  earlier_velocities_ = velocities_;
  if (system_.damping().hasDampers()) {
    damped_kick_ = std::make_unique<DampedKick>(system_, layout_, kernels.damping, threads_);
  } else if (system_.damping().hasViscous()) {
    dissipated_.assign(layout_.patches().size(), 0);
  }
  for (const Patch& patch : layout_.patches()) {
    for (std::uint32_t i = 0; i < patch.particle_count; ++i) {
      const std::uint32_t particle = layout_.order()[patch.first_place + i];
      inverse_masses_[patch.first_slot + i] = system_.inverseMasses()[particle];
      rows_[particle] = patch.first_row + i;
      slots_[particle] = patch.first_slot + i;
    }
  }
}

void Motion::copyTo(Copy& copy) const {
  copy.positions = positions_;
  copy.velocities = velocities_;
}

void Motion::putBack(const Copy& copy) {
  positions_ = copy.positions;
  velocities_ = copy.velocities;
}

void Motion::putBack(std::uint32_t particle, const Copy& copy) {
  positions_[rows_[particle]] = copy.positions[rows_[particle]];
  const std::uint32_t slot = slots_[particle];
  for (std::size_t k = 0; k < velocities_.size(); ++k) {
    velocities_[k][slot] = copy.velocities[k][slot];
  }
}

void Motion::copyVelocities(const Patch& patch, const Velocities& from, Velocities& to) {
  for (std::size_t k = 0; k < from.size(); ++k) {
    std::copy_n(&from[k][patch.first_slot], patch.slotCount(), &to[k][patch.first_slot]);
  }
}

bool Motion::isNear(std::size_t patch) const {
  const NearElements& near = near_[patch];
  return std::any_of(near.begin(), near.end(), [](const auto& list) { return !list.empty(); });
}

bool Motion::isNear() const {
  for (std::size_t b = 0; b < near_.size(); ++b) {
    if (isNear(b)) return true;
  }
  return false;
}

void Motion::place(std::uint32_t particle, const Vector3& position,
                   const Vector3& angular_velocity) {
  Eigen::Map<Vector3>(positions_[rows_[particle]].values) = position;
  for (int k = 0; k < 3; ++k) velocities_[k][slots_[particle]] = angular_velocity[k];
}

void Motion::take(const State& state) {
  for (const Patch& patch : layout_.patches()) {
    for (std::uint32_t i = 0; i < patch.particle_count; ++i) {
      const std::uint32_t particle = layout_.order()[patch.first_place + i];
      for (int k = 0; k < 3; ++k) {
        positions_[patch.first_row + i].values[k] = state.positions(k, particle);
        velocities_[k][patch.first_slot + i] = state.angular_velocities(k, particle);
      }
    }
  }
}

void Motion::give(State& state) const {
  const auto count = static_cast<Eigen::Index>(layout_.order().size());
  state.positions.resize(3, count);
  state.angular_velocities.resize(3, count);
  for (const Patch& patch : layout_.patches()) {
    for (std::uint32_t i = 0; i < patch.particle_count; ++i) {
      const std::uint32_t particle = layout_.order()[patch.first_place + i];
      for (int k = 0; k < 3; ++k) {
        state.positions(k, particle) = positions_[patch.first_row + i].values[k];
        state.angular_velocities(k, particle) = velocities_[k][patch.first_slot + i];
      }
    }
  }
}

Particles Motion::particlesOf(const Patch& patch, const std::vector<Row>& positions,
                              std::vector<Row>& moved, const Row* forces) {
  return {positions[patch.first_row].values,
          moved[patch.first_row].values,
          {&velocities_[0][patch.first_slot], &velocities_[1][patch.first_slot],
           &velocities_[2][patch.first_slot]},
          forces == nullptr ? nullptr : forces->values,
          &inverse_masses_[patch.first_slot],
          patch.slotCount()};
}

template <class Work>
void Motion::forEachPatch(const Work& work) {
  const auto& patches = layout_.patches();
  forOnThreads(patches.size(), threads_, [&](std::ptrdiff_t b) {
    if (patches[b].particle_count > 0) work(b, patches[b]);
  });
}

void Motion::drift(double duration) {
  forEachPatch([&](std::size_t, const Patch& patch) {
    kernels_.drift(particlesOf(patch, positions_, positions_, nullptr), duration);
  });
}

void Motion::prepareKick(double kick) {
  if (damped_kick_ != nullptr) {
    damped_kick_->prepare(kick);
  } else if (system_.damping().hasViscous()) {
    viscous_flows_.prepare(kick, system_.damping(), layout_);
  }
}

std::optional<double> Motion::kickAndDrift(double kick, const Drifts& drifts, bool until_near) {
  if (damped_kick_ != nullptr) {
    if (takeTorques({}) && until_near) return std::nullopt;
    const double taken = kickUnderSpringDamping(kick);
    forEachPatch([&](std::size_t, const Patch& patch) {
      driftPatch(particlesOf(patch, positions_, moved_, nullptr), drifts);
    });
    positions_.swap(moved_);
    return taken;
  }
  const bool is_sole = layout_.patches().size() == 1;
  const bool damped = system_.damping().hasViscous();
  const ViscousFlow* const viscous = damped ? &viscous_flows_.over(kick) : nullptr;
  forEachPatch([&](std::size_t b, const Patch& patch) {
    const auto scratch = scratches_.lease(patch);
    const Row* const forces = forcesOn(patch, *scratch, until_near ? &near_[b] : nullptr);
    if (until_near && isNear(b)) return;
    if (until_near && !is_sole) copyVelocities(patch, velocities_, earlier_velocities_);
    const Particles particles = particlesOf(patch, positions_, moved_, forces);
    const double taken = kickPatch(particles, patch, kick, viscous);
    if (damped) dissipated_[b] = taken;
    driftPatch(particles, drifts);
  });
  if (until_near && undoIfNear()) return std::nullopt;
  positions_.swap(moved_);
  double taken = 0;
  for (const double of_patch : dissipated_) taken += of_patch;
  return taken;
}

/// Puts back the velocities of patches that were kicked, where springs of others may be near.
bool Motion::undoIfNear() {
  if (!isNear()) return false;
  forEachPatch([&](std::size_t b, const Patch& patch) {
    if (!isNear(b)) copyVelocities(patch, earlier_velocities_, velocities_);
  });
  return true;
}

double Motion::kick(double kick, const SpringSubset& left_out) {
  if (damped_kick_ != nullptr) {
    takeTorques(left_out);
    return kickUnderSpringDamping(kick);
  }
  const bool damped = system_.damping().hasViscous();
  const ViscousFlow* const viscous = damped ? &viscous_flows_.over(kick) : nullptr;
  forEachPatch([&](std::size_t b, const Patch& patch) {
    const auto scratch = scratches_.lease(patch);
    const Row* const forces = forcesOn(patch, *scratch, &near_[b]);
    subtractForces(patch, left_out, *scratch);
    const double taken =
        kickPatch(particlesOf(patch, positions_, moved_, forces), patch, kick, viscous);
    if (damped) dissipated_[b] = taken;
  });
  double taken = 0;
  for (const double of_patch : dissipated_) taken += of_patch;
  return taken;
}

const Row* Motion::forcesOn(const Patch& patch, Scratch& scratch, NearElements* near) {
  fetch(patch);
  layout_.updateGhosts(patch, positions_);
  return forces_.on(patch, &positions_[patch.first_row], scratch, near);
}

void Motion::subtractForces(const Patch& patch, const SpringSubset& springs,
                            Scratch& scratch) const {
  const auto isOwn = [&](std::uint32_t particle) {
    return rows_[particle] - patch.first_row < patch.particle_count;
  };
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    for (const std::uint32_t index : springs.get<Spring>()) {
      const Spring spring = turned(system_.springs<Spring>()[index], rows_);
      const auto& ends = spring.particles;
      if (std::none_of(ends.begin(), ends.end(), isOwn)) continue;
      std::array<Vector3, Spring::kParticles> points;
      for (std::size_t i = 0; i < points.size(); ++i) points[i] = position(ends[i]);
      const auto forces = forcesOf(spring, points);
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (!isOwn(ends[i])) continue;
        Eigen::Map<Vector3>(scratch.sums[rows_[ends[i]] - patch.first_row].values) -= forces[i];
      }
    }
  });
}

double Motion::kickPatch(const Particles& particles, const Patch& patch, double kick,
                         const ViscousFlow* viscous) const {
  if (viscous == nullptr) {
    kernels_.kick(particles, kick);
    return 0;
  }
  const std::uint32_t at = patch.first_slot;
  return kernels_.viscous_kick(
      particles, {&viscous->decay[at],
                  &viscous->gain[at],
                  {&viscous->taken[0][at], &viscous->taken[1][at], &viscous->taken[2][at]}});
}

/// @return whether springs may be near a place without derivative.
bool Motion::takeTorques(const SpringSubset& left_out) {
  forEachPatch([&](std::size_t b, const Patch& patch) {
    const auto scratch = scratches_.lease(patch);
    const Row* const forces = forcesOn(patch, *scratch, &near_[b]);
    subtractForces(patch, left_out, *scratch);
    damped_kick_->takeTorques(b, particlesOf(patch, positions_, moved_, forces));
    damped_kick_->takeGradients(b, &positions_[patch.first_row]);
  });
  return isNear();
}

double Motion::kickUnderSpringDamping(double kick) {
  return damped_kick_->kick(kick,
                            {{velocities_[0].data(), velocities_[1].data(), velocities_[2].data()},
                             inverse_masses_.data(),
                             positions_.data()});
}

void Motion::driftPatch(Particles particles, const Drifts& drifts) const {
  for (const double duration : drifts) {
    if (duration == 0) continue;
    kernels_.drift(particles, duration);
    particles.positions = particles.moved;
  }
}

double Motion::fastestRate() {
  forEachPatch([&](std::size_t b, const Patch& patch) {
    layout_.updateGhosts(patch, positions_);
    damped_kick_->takeGradients(b, &positions_[patch.first_row]);
  });
  return damped_kick_->fastestRate();
}

/// Brings the positions nearer before they are wanted here and there.
void Motion::fetch(const Patch& patch) const {
  constexpr std::uint32_t kRowsOfALine = 2;
  for (std::uint32_t i = 0; i < patch.slotCount(); i += kRowsOfALine) {
    __builtin_prefetch(&positions_[patch.first_row + i]);
  }
}

}  // namespace spherical_springs::core
