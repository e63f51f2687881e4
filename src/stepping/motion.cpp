#include "stepping/motion.h"

#include <utility>

#include "base/parallel.h"

namespace spherical_springs::core {

Motion::Motion(std::shared_ptr<const Plan> plan, const StepKernels& kernels)
    : plan_(std::move(plan)),
      system_(*plan_->system()),
      layout_(plan_->layout()),
      kernels_(kernels),
      forces_(layout_, kernels),
      threads_(layout_.patches().size() > 1 ? system_.threads() : 1),
      scratches_(layout_, mostElements(layout_), threads_),
      positions_(layout_.rowCount(), Row{{1, 0, 0, 0}}),
      moved_(positions_),
      inverse_masses_(layout_.slotCount(), 0) {
  for (auto& component : velocities_) component.assign(layout_.slotCount(), 0);
  if (system_.damping().hasDampers()) {
    damped_kick_ = std::make_unique<DampedKick>(system_, layout_, kernels.damping, threads_);
  } else if (system_.damping().hasViscous()) {
    dissipated_.assign(layout_.patches().size(), 0);
  }
  for (const Patch& patch : layout_.patches()) {
    for (std::uint32_t i = 0; i < patch.particle_count; ++i) {
      inverse_masses_[patch.first_slot + i] =
          system_.inverseMasses()[layout_.order()[patch.first_place + i]];
    }
  }
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

double Motion::kickAndDrift(double kick, const Drifts& drifts) {
  if (damped_kick_ != nullptr) {
    const double taken = kickUnderSpringDamping(kick);
    forEachPatch([&](std::size_t, const Patch& patch) {
      driftPatch(particlesOf(patch, positions_, moved_, nullptr), drifts);
    });
    positions_.swap(moved_);
    return taken;
  }
  const bool damped = system_.damping().hasViscous();
  const ViscousFlow* const viscous = damped ? &viscous_flows_.over(kick) : nullptr;
  forEachPatch([&](std::size_t b, const Patch& patch) {
    const auto scratch = scratches_.lease(patch);
    const Particles particles = particlesOf(patch, positions_, moved_, forcesOn(patch, *scratch));
    const double taken = kickPatch(particles, patch, kick, viscous);
    if (damped) dissipated_[b] = taken;
    driftPatch(particles, drifts);
  });
  positions_.swap(moved_);
  double taken = 0;
  for (const double of_patch : dissipated_) taken += of_patch;
  return taken;
}

const Row* Motion::forcesOn(const Patch& patch, Scratch& scratch) {
  fetch(patch);
  layout_.updateGhosts(patch, positions_);
  return forces_.on(patch, &positions_[patch.first_row], scratch);
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

double Motion::kickUnderSpringDamping(double kick) {
  forEachPatch([&](std::size_t b, const Patch& patch) {
    const auto scratch = scratches_.lease(patch);
    damped_kick_->takeTorques(b, particlesOf(patch, positions_, moved_, forcesOn(patch, *scratch)));
    damped_kick_->takeGradients(b, &positions_[patch.first_row]);
  });
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
