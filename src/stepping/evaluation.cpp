#include "stepping/evaluation.h"

#include <algorithm>
#include <tuple>

#include "base/parallel.h"
#include "stepping/exact_springs.h"
#include "stepping/forces.h"

namespace spherical_springs::core {

Evaluation::Evaluation(const Plan& plan, const Points& positions, const StepKernels& kernels)
    : system_(*plan.system()),
      layout_(plan.layout()),
      kernels_(kernels),
      positions_(layout_.rowCount(), Row{{1, 0, 0, 0}}),
      scratches_(layout_, mostElements(layout_), threads()) {
  forEachPatch([&](std::size_t, const Patch& patch) {
    for (std::uint32_t i = 0; i < patch.particle_count; ++i) {
      Eigen::Map<Vector3>(positions_[patch.first_row + i].values) =
          positions.col(layout_.order()[patch.first_place + i]);
    }
  });
  forEachPatch([&](std::size_t, const Patch& patch) { layout_.updateGhosts(patch, positions_); });
}

int Evaluation::threads() const { return layout_.patches().size() > 1 ? system_.threads() : 1; }

template <class Work>
void Evaluation::forEachPatch(const Work& work) const {
  const auto& patches = layout_.patches();
  forOnThreads(patches.size(), threads(), [&](std::ptrdiff_t p) {
    if (patches[p].particle_count > 0) work(p, patches[p]);
  });
}

PotentialEnergies Evaluation::potential() const {
  std::vector<PotentialEnergies> of_patches(layout_.patches().size());
  forEachPatch([&](std::size_t p, const Patch& patch) { of_patches[p] = potentialOf(patch); });
  PotentialEnergies sum;
  for (const PotentialEnergies& of_patch : of_patches) {
    forEachKind([&](auto kind) {
      using Spring = typename decltype(kind)::type;
      sum.get<Spring>().joules += of_patch.get<Spring>().joules;
    });
  }
  return sum;
}

PotentialEnergies Evaluation::potentialOf(const Patch& patch) const {
  PotentialEnergies energies;
  const auto scratch = scratches_.lease(patch);
  forEachSort([&](auto sort) { addEnergies(sort, patch, *scratch, energies); });
  return energies;
}

namespace {

double& firstOf(const Arcs&, PotentialEnergies& energies) {
  return energies.get<AngleSpring>().joules;
}
template <int kSprings>
double& firstOf(const ElementGroup<3, kSprings>&, PotentialEnergies& energies) {
  return energies.get<SolidAngleSpring>().joules;
}
double& firstOf(const OrientedArcs&, PotentialEnergies& energies) {
  return energies.get<OrientedAngleSpring>().joules;
}
template <class Spring>
double& firstOf(const PlainSprings<Spring>&, PotentialEnergies& energies) {
  return energies.get<Spring>().joules;
}

}  // namespace

// A spring counts in the patch of the first end of its element.
template <class Group>
void Evaluation::addEnergies(Kind<Group> sort, const Patch& patch, Scratch& scratch,
                             PotentialEnergies& energies) const {
  const auto [begin, end] = patch.groups[sortOf<Group>()];
  if (begin == end) return;
  const Group* const groups = std::get<GroupList<Group>>(layout_.groups()).data() + begin;
  const Row* const positions = &positions_[patch.first_row];
  ElementEnergies added = {0, 0};
  const std::uint32_t hard_count =
      energyKernel(kernels_, sort)(groups, end - begin, positions->values,
                                   kRowLength * patch.slotCount(), added, scratch.hard.data());
  firstOf(*groups, energies) += added.first;
  energies.get<AngleSpring>().joules += added.arcs;
  for (std::uint32_t h = 0; h < hard_count; ++h) {
    const std::uint32_t element = scratch.hard[h];
    const auto add = [&](const auto& spring, const auto& rows) {
      const double c = condition(spring, pointsAt(rows, positions)).value;
      energies.get<std::decay_t<decltype(spring)>>().joules += 0.5 * spring.stiffness * c * c;
    };
    forEachSpring(groups[element / kGroup], element % kGroup, add);
  }
}

double Evaluation::maxTorque() const {
  std::vector<double> of_patches(layout_.patches().size(), 0);
  forEachPatch([&](std::size_t p, const Patch& patch) {
    forEachTorque(patch, [&](std::uint32_t, double torque) {
      of_patches[p] = std::max(of_patches[p], torque);
    });
  });
  return *std::max_element(of_patches.begin(), of_patches.end());
}

Evaluation::LargestTorque Evaluation::largestTorque(const Eigen::VectorXd& allowed) const {
  std::vector<LargestTorque> of_patches(layout_.patches().size());
  forEachPatch([&](std::size_t p, const Patch& patch) {
    LargestTorque& largest = of_patches[p];
    forEachTorque(patch, [&](std::uint32_t particle, double torque) {
      largest.torque = std::max(largest.torque, torque);
      if (torque > 0) largest.excess = std::max(largest.excess, torque / allowed[particle]);
    });
  });
  LargestTorque largest;
  for (const LargestTorque& of_patch : of_patches) {
    largest.torque = std::max(largest.torque, of_patch.torque);
    largest.excess = std::max(largest.excess, of_patch.excess);
  }
  return largest;
}

/// Calls `visit(particle, torque [N m])` for each particle of a patch that is not pinned.
template <class Visit>
void Evaluation::forEachTorque(const Patch& patch, const Visit& visit) const {
  const Row* const positions = &positions_[patch.first_row];
  const auto scratch = scratches_.lease(patch);
  const Row* const forces = Forces(layout_, kernels_).on(patch, positions, *scratch);
  for (std::uint32_t i = 0; i < patch.particle_count; ++i) {
    const std::uint32_t particle = layout_.order()[patch.first_place + i];
    if (system_.pinned(particle)) continue;
    const Eigen::Map<const Vector3> position(positions[i].values), force(forces[i].values);
    const Vector3 torque = position.cross(force);
    visit(particle, torque.norm());
  }
}

}  // namespace spherical_springs::core
