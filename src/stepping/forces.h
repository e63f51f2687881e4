// Forces of the springs on the particles of a patch.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "stepping/layout.h"
#include "stepping/scratch.h"
#include "stepping/step_kernels.h"

namespace spherical_springs::core {

/// Forces by the kernels, and for the hard elements by the springs' own formulas.
class Forces {
 public:
  Forces(const Layout& layout, const StepKernels& kernels) : layout_(layout), kernels_(kernels) {}

  /// Adds the forces on the particles of a patch, whose rows begin at `positions`, to the sums of
  /// `scratch`.
  /// @return the first of these sums.
  const Row* on(const Patch& patch, const Row* positions, Scratch& scratch) const;

 private:
  template <class Group>
  void addElements(Kind<Group>, const Patch& patch, const Row* positions, Scratch& scratch) const;

  const Layout& layout_;
  const StepKernels& kernels_;
};

}  // namespace spherical_springs::core
