#include "motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "../parallel.h"

namespace spherical_springs::core {

Motion::Motion(std::shared_ptr<const System> system, std::shared_ptr<const Layout> layout,
               const StepKernels& kernels)
    : system_(std::move(system)),
      layout_(std::move(layout)),
      kernels_(kernels),
      threads_(layout_->patches().size() > 1 ? system_->threads() : 1),
      positions_(layout_->rowCount(), Row{{1, 0, 0, 0}}),
      moved_(positions_),
      inverse_masses_(layout_->slotCount(), 0) {
  for (auto& component : velocities_) component.assign(layout_->slotCount(), 0);
  if (system_->damping().hasViscous()) dissipated_.assign(layout_->patches().size(), 0);
  for (const Patch& patch : layout_->patches()) {
    for (std::uint32_t i = 0; i < patch.particle_count; ++i) {
      inverse_masses_[patch.first_slot + i] =
          system_->inverseMasses()[layout_->order()[patch.first_place + i]];
    }
  }
}

void Motion::take(const State& state) {
  for (const Patch& patch : layout_->patches()) {
    for (std::uint32_t i = 0; i < patch.particle_count; ++i) {
      const std::uint32_t particle = layout_->order()[patch.first_place + i];
      for (int k = 0; k < 3; ++k) {
        positions_[patch.first_row + i].values[k] = state.positions(k, particle);
        velocities_[k][patch.first_slot + i] = state.angular_velocities(k, particle);
      }
    }
  }
}

void Motion::give(State& state) const {
  const auto count = static_cast<Eigen::Index>(layout_->order().size());
  state.positions.resize(3, count);
  state.angular_velocities.resize(3, count);
  for (const Patch& patch : layout_->patches()) {
    for (std::uint32_t i = 0; i < patch.particle_count; ++i) {
      const std::uint32_t particle = layout_->order()[patch.first_place + i];
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

void Motion::drift(double duration) {
  const auto& patches = layout_->patches();
  forOnThreads(patches.size(), threads_, [&](std::ptrdiff_t b) {
    if (patches[b].particle_count == 0) return;
    kernels_.drift(particlesOf(patches[b], positions_, positions_, nullptr), duration);
  });
}

double Motion::kickAndDrift(double kick, const Drifts& drifts) {
  const auto& patches = layout_->patches();
  const bool damped = system_->damping().hasViscous();
  const Viscous* const viscous = damped ? &viscousFor(kick) : nullptr;
  forOnThreads(patches.size(), threads_, [&](std::ptrdiff_t b) {
    if (patches[b].particle_count == 0) return;
    const double taken = kickAndDriftPatch(patches[b], kick, viscous, drifts);
    if (damped) dissipated_[b] = taken;
  });
  positions_.swap(moved_);
  double taken = 0;
  for (const double of_patch : dissipated_) taken += of_patch;
  return taken;
}

double Motion::kickAndDriftPatch(const Patch& patch, double kick, const Viscous* viscous,
                                 const Drifts& drifts) {
  static thread_local Scratch scratch;
  if (scratch.forces.size() < layout_->largestPatch()) {
    scratch.forces.resize(layout_->largestPatch());
  }
  if (scratch.hard.size() < layout_->mostElements()) scratch.hard.resize(layout_->mostElements());
  fetch(patch);
  welcomeGuests(patch);
  std::fill_n(scratch.forces.begin(), patch.row_count, Row{});
  addForces(patch, scratch);

  Particles particles = particlesOf(patch, positions_, moved_, scratch.forces.data());
  double taken = 0;
  if (viscous != nullptr) {
    const std::uint32_t at = patch.first_slot;
    taken = kernels_.viscous_kick(
        particles, {&viscous->decay[at],
                    &viscous->gain[at],
                    {&viscous->taken[0][at], &viscous->taken[1][at], &viscous->taken[2][at]}});
  } else {
    kernels_.kick(particles, kick);
  }
  for (const double duration : drifts) {
    if (duration == 0) continue;
    kernels_.drift(particles, duration);
    particles.positions = particles.moved;
  }
  return taken;
}

const Motion::Viscous& Motion::viscousFor(double duration) {
  for (const Viscous& known : viscous_) {
    if (known.duration == duration) return known;
  }
  Viscous made{duration, {}, {}, {}};
  const std::size_t count = inverse_masses_.size();
  made.decay.assign(count, 1);
  made.gain.assign(count, 0);
  for (auto& taken : made.taken) taken.assign(count, 0);
  for (const Patch& patch : layout_->patches()) {
    for (std::uint32_t i = 0; i < patch.particle_count; ++i) {
      const std::uint32_t particle = layout_->order()[patch.first_place + i];
      const auto flow = system_->damping().viscousFlow(particle, duration);
      const std::uint32_t slot = patch.first_slot + i;
      made.decay[slot] = flow.decay;
      made.gain[slot] = flow.gain;
      for (int k = 0; k < 3; ++k) made.taken[k][slot] = flow.taken[k];
    }
  }
  viscous_.push_back(std::move(made));
  return viscous_.back();
}

/// Brings the positions nearer before they are wanted here and there.
void Motion::fetch(const Patch& patch) const {
  constexpr std::uint32_t kRowsOfALine = 2;
  for (std::uint32_t i = 0; i < patch.slotCount(); i += kRowsOfALine) {
    __builtin_prefetch(&positions_[patch.first_row + i]);
  }
}

/// The present positions of the particles of other patches.
void Motion::welcomeGuests(const Patch& patch) {
  const std::uint32_t* const home = layout_->guests().data() + patch.first_guest;
  const std::uint32_t first = patch.first_row + patch.slotCount();
  const std::uint32_t count = patch.row_count - patch.slotCount();
  for (std::uint32_t i = 0; i < count; ++i) positions_[first + i] = positions_[home[i]];
}

void Motion::addForces(const Patch& patch, Scratch& scratch) const {
  addElements<0>(patch, scratch);
  addElements<1>(patch, scratch);
  addElements<2>(patch, scratch);
  addElements<3>(patch, scratch);
  addElements<4>(patch, scratch);
}

template <int kSort>
void Motion::addElements(const Patch& patch, Scratch& scratch) const {
  const auto [begin, end] = patch.groups[kSort];
  if (begin == end) return;
  const auto* const groups = std::get<kSort>(layout_->groups()).data() + begin;
  const std::uint32_t hard_count =
      std::get<kSort>(kernels_.forces)(groups, end - begin, positions_[patch.first_row].values,
                                       scratch.forces[0].values, scratch.hard.data());
  for (std::uint32_t h = 0; h < hard_count; ++h) {
    addExactly(patch, groups[scratch.hard[h] / kGroup], scratch.hard[h] % kGroup, scratch);
  }
}

template <int kEnds, int kSprings>
void Motion::addExactly(const Patch& patch, const ElementGroup<kEnds, kSprings>& group,
                        std::uint32_t lane, Scratch& scratch) const {
  const auto row = [&](int end) {
    return static_cast<std::uint32_t>(group.ends[end][lane] / kRowLength);
  };
  if constexpr (kEnds == 3) {
    SolidAngleSpring triangle;
    triangle.rest_solid_angle = group.springs[0].rest[lane];
    triangle.stiffness = group.springs[0].stiffness[lane];
    addExactly(patch, triangle, {row(0), row(1), row(2)}, scratch);
  }
  constexpr int kFirstArc = kEnds - 2;
  for (int i = kFirstArc; i < kSprings; ++i) {
    AngleSpring arc;
    arc.rest_angle = group.springs[i].rest[lane];
    arc.stiffness = group.springs[i].stiffness[lane];
    addExactly(patch, arc, {row(i - kFirstArc), row(i - kFirstArc + 1)}, scratch);
  }
}

void Motion::addExactly(const Patch& patch, const OrientedArcs& group, std::uint32_t lane,
                        Scratch& scratch) const {
  OrientedAngleSpring spring;
  spring.rest_angle = group.rest[lane];
  spring.stiffness = group.stiffness[lane];
  spring.width = std::max(group.width[lane], std::numeric_limits<double>::min());
  std::array<std::uint32_t, 3> rows;
  for (int i = 0; i < 3; ++i) {
    rows[i] = static_cast<std::uint32_t>(group.ends[i][lane] / kRowLength);
  }
  addExactly(patch, spring, rows, scratch);
}

template <class Spring>
void Motion::addExactly(const Patch& patch, const Spring& spring,
                        const std::array<std::uint32_t, Spring::kParticles>& rows,
                        Scratch& scratch) const {
  std::array<Vector3, Spring::kParticles> points;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    points[i] = Eigen::Map<const Vector3>(positions_[patch.first_row + rows[i]].values);
  }
  const auto c = condition(spring, points);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Vector3 torque = -spring.stiffness * c.value * c.gradient[i];
    Eigen::Map<Vector3>(scratch.forces[rows[i]].values) += torque.cross(points[i]);
  }
}

std::size_t Motion::bytes() const {
  return 2 * positions_.size() * sizeof(Row) +
         (3 + 1 + 5 * viscous_.size()) * inverse_masses_.size() * sizeof(double);
}

}  // namespace spherical_springs::core
