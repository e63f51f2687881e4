// Dampers one after another, each by its exact flow.
#pragma once

#include <cstdint>
#include <vector>

#include "stepping/damper_layout.h"

namespace spherical_springs::core {

template <class Spring>
struct DamperGradients : std::vector<GradientsOf<DampersOf<Spring>>> {};

class DamperSweep {
 public:
  /// `own`: whether dampers act on the ends each by itself.
  DamperSweep(const DamperLayout& dampers, const PerKind<DamperGradients>& gradients,
              const DampingKernels& kernels, bool own)
      : dampers_(dampers), gradients_(gradients), kernels_(kernels), own_(own) {}

  /// Takes the memory for all flows; to be called before flows are taken.
  void makeRoom();

  /// Takes the flows of a patch's dampers over `duration` [s] at the present gradients.
  void takeFlows(std::size_t patch, double duration);

  /// The dampers that have all ends in a patch, whose rows begin at `velocities`, in some order and
  /// in the opposite one.
  /// @return the energy that they took out [J].
  double innerForward(std::size_t patch, Row* velocities) const;
  double innerBackward(std::size_t patch, Row* velocities) const;

  /// Lets the dampers between patches act, in turn and back. `velocities` has the rows of all
  /// patches.
  /// @return the energy taken out [J].
  double shared(Row* velocities) const;

 private:
  template <class Spring>
  struct Flows : std::vector<DamperFlow> {};

  static DamperFlow flowOf(double mobility, double duration);
  template <class Spring>
  std::size_t flowIndex(std::uint32_t group, std::uint32_t lane) const;
  template <class Spring>
  DamperChain<DampersOf<Spring>> chain(std::size_t patch) const;
  template <class Spring>
  double dampShared(const SharedDamper& damper, Row* velocities) const;

  const DamperLayout& dampers_;
  const PerKind<DamperGradients>& gradients_;
  const DampingKernels& kernels_;
  const bool own_;
  PerKind<Flows> flows_;  // one a damper, or one an end
};

}  // namespace spherical_springs::core
