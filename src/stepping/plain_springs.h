// Springs of kinds that have no kernels: each is computed by its own formula, one at a time.
#pragma once

#include <cstdint>
#include <tuple>
#include <type_traits>
#include <vector>

#include "spherical_springs/springs/kinds.h"
#include "stepping/step_kernels.h"

namespace spherical_springs::core {

/// Whether `StepKernels` take the springs of a kind.
template <class Spring>
inline constexpr bool kHasStepKernels = false;
template <>
inline constexpr bool kHasStepKernels<AngleSpring> = true;
template <>
inline constexpr bool kHasStepKernels<SolidAngleSpring> = true;
template <>
inline constexpr bool kHasStepKernels<OrientedAngleSpring> = true;

/// Springs of a kind without kernels, in groups as kernels take others.
template <class Spring>
struct PlainSprings {
  static constexpr int kSpringsOfOne = 1;

  std::uint32_t ends[Spring::kParticles][kGroup];  ///< where rows of particles begin [doubles]
  Spring springs[kGroup];
};

/// Damped springs of a kind without kernels for their gradients.
template <class Spring>
struct PlainDampers : DamperGroup<Spring::kParticles> {
  Spring springs[kGroup];
};

namespace detail {

template <class Spring>
using PlainSorts =
    std::conditional_t<kHasStepKernels<Spring>, std::tuple<>, std::tuple<PlainSprings<Spring>>>;

template <class List>
struct SortsOf;
template <class... Springs>
struct SortsOf<KindList<Springs...>> {
  using type = decltype(std::tuple_cat(
      std::tuple<Arcs, Triangles<0>, Triangles<1>, Triangles<2>, OrientedArcs>(),
      PlainSorts<Springs>()...));
};

}  // namespace detail

/// The sorts of groups that springs lie in: those of the kernels, then one for each kind without.
using Sorts = detail::SortsOf<Kinds>::type;
inline constexpr std::size_t kSortCount = std::tuple_size_v<Sorts>;

/// Returns the place of a group in `Sorts`.
template <class Group, std::size_t kSort = 0>
constexpr std::size_t sortOf() {
  if constexpr (std::is_same_v<Group, std::tuple_element_t<kSort, Sorts>>) {
    return kSort;
  } else {
    return sortOf<Group, kSort + 1>();
  }
}

/// Calls `visit(Kind<Group>())` for each sort of groups.
template <class Visitor, std::size_t... kSorts>
void forEachSort(const Visitor& visit, std::index_sequence<kSorts...>) {
  (visit(Kind<std::tuple_element_t<kSorts, Sorts>>()), ...);
}
template <class Visitor>
void forEachSort(const Visitor& visit) {
  forEachSort(visit, std::make_index_sequence<kSortCount>());
}

template <class Group>
ForceKernel<Group> forceKernel(const StepKernels& kernels, Kind<Group>) {
  return std::get<ForceKernel<Group>>(kernels.forces);
}
/// Returns a kernel that leaves all springs to their formula.
template <class Spring>
ForceKernel<PlainSprings<Spring>> forceKernel(const StepKernels&, Kind<PlainSprings<Spring>>) {
  return [](const PlainSprings<Spring>*, std::uint32_t group_count, const double*, double*,
            MarkedElements& marked) {
    marked.hard_count = group_count * static_cast<std::uint32_t>(kGroup);
    for (std::uint32_t s = 0; s < marked.hard_count; ++s) marked.hard[s] = s;
  };
}

template <class Group>
EnergyKernel<Group> energyKernel(const StepKernels& kernels, Kind<Group>) {
  return std::get<EnergyKernel<Group>>(kernels.energies);
}
/// Returns a kernel that leaves all springs below the limit to their formula.
template <class Spring>
EnergyKernel<PlainSprings<Spring>> energyKernel(const StepKernels&, Kind<PlainSprings<Spring>>) {
  return [](const PlainSprings<Spring>* groups, std::uint32_t group_count, const double*,
            std::uint32_t limit, ElementEnergies&, std::uint32_t* hard) {
    std::uint32_t count = 0;
    for (std::uint32_t s = 0; s < group_count * kGroup; ++s) {
      if (groups[s / kGroup].ends[0][s % kGroup] < limit) hard[count++] = s;
    }
    return count;
  };
}

}  // namespace spherical_springs::core
