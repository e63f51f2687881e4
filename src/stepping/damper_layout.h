// Damped springs where the kernels want them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "spherical_springs/system.h"
#include "stepping/damping_kernels.h"
#include "stepping/groups.h"
#include "stepping/layout.h"

namespace spherical_springs::core {

template <class Spring>
struct DampersFor : Kind<PlainDampers<Spring>> {};
template <>
struct DampersFor<AngleSpring> : Kind<ArcDampers> {};
template <>
struct DampersFor<SolidAngleSpring> : Kind<TriangleDampers> {};
template <>
struct DampersFor<OrientedAngleSpring> : Kind<OrientedArcDampers> {};
template <class Spring>
using DampersOf = typename DampersFor<Spring>::type;

/// Kernels for a kind that `DampingKernels` do not have; its gradients they leave to its formula.
template <class Spring>
struct PlainDamperKernels {
  std::conditional_t<kHasStepKernels<Spring>, std::tuple<>, DamperKernels<DampersOf<Spring>>> all;
};
const PerKind<PlainDamperKernels>& plainDamperKernels();

/// Returns the kernels for a kind of springs.
template <class Spring>
const DamperKernels<DampersOf<Spring>>& damperKernels(const DampingKernels& kernels) {
  if constexpr (kHasStepKernels<Spring>) {
    return std::get<DamperKernels<DampersOf<Spring>>>(kernels.springs);
  } else {
    return plainDamperKernels().get<Spring>().all;
  }
}

template <class Spring>
struct DamperGroups : std::vector<DampersOf<Spring>> {};

/// A patch's share of the damped springs of a kind: those that have all ends in it, then those that
/// it shares with others.
template <class Spring>
struct DamperShare {
  GroupRange groups;
  std::uint32_t inner = 0;  ///< how many have all ends in it
};

/// Springs between patches, each once.
struct SharedDamper {
  std::uint32_t group, lane;
  std::array<std::uint32_t, kMostEnds> rows;  ///< owned, of its ends
};
template <class Spring>
struct SharedDampers : std::vector<SharedDamper> {};

class DamperLayout {
 public:
  DamperLayout(const System& system, const Layout& layout);

  const PerKind<DamperGroups>& groups() const { return groups_; }
  const std::vector<PerKind<DamperShare>>& shares() const { return shares_; }  ///< of each patch
  const PerKind<SharedDampers>& shared() const { return shared_; }

 private:
  class Builder;

  PerKind<DamperGroups> groups_;
  std::vector<PerKind<DamperShare>> shares_;
  PerKind<SharedDampers> shared_;
};

}  // namespace spherical_springs::core
