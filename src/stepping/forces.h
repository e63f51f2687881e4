// Forces of the springs on the particles of a patch.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "stepping/layout.h"
#include "stepping/scratch.h"
#include "stepping/step_kernels.h"

namespace spherical_springs::core {

/// Elements of each sort, counted within a patch, whose springs may be near a place where their
/// conditions have no derivative.
using NearElements = std::array<std::vector<std::uint32_t>, kSortCount>;

/// Forces by the kernels, and for the hard elements by the springs' own formulas.
class Forces {
 public:
  Forces(const Layout& layout, const StepKernels& kernels) : layout_(layout), kernels_(kernels) {}

  /// Adds the forces on the particles of a patch, whose rows begin at `positions`, to the sums of
  /// `scratch`, and lists the elements that are near, unless `near` is null.
  /// @return the sums: one for each row of the patch; those of ghosts mean nothing.
  const Row* on(const Patch& patch, const Row* positions, Scratch& scratch,
                NearElements* near = nullptr) const;

 private:
  template <class Group>
  void addElements(Kind<Group>, const Patch& patch, const Row* positions, Scratch& scratch,
                   NearElements* near) const;

  const Layout& layout_;
  const StepKernels& kernels_;
};

}  // namespace spherical_springs::core
