// What springs do to the particles of a patch.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "../kernels/step_kernels.h"
#include "layout.h"

namespace spherical_springs::core {

/// Memory of a thread for the patch that it is at.
struct Scratch {
  std::vector<Row> sums;            ///< a row for each of a patch
  std::vector<std::uint32_t> hard;  ///< indices of elements

  static Scratch& ofThisThread();

  /// That of the calling thread, with room for any patch of a layout; sums are 0 in as many rows as
  /// `patch` has.
  static Scratch& cleared(const Layout& layout, const Patch& patch);

  /// For so many hard elements.
  void makeRoom(std::uint32_t count) {
    if (hard.size() < count) hard.resize(count);
  }
};

/// Forces by the kernels, and for the hard elements by the springs' own formulas.
class Forces {
 public:
  Forces(const Layout& layout, const StepKernels& kernels) : layout_(layout), kernels_(kernels) {}

  /// On the particles of a patch whose rows begin at `positions`. They lie in the scratch memory of
  /// the calling thread.
  const Row* on(const Patch& patch, const Row* positions) const;

 private:
  template <int kSort>
  void addElements(const Patch& patch, const Row* positions, Scratch& scratch) const;

  const Layout& layout_;
  const StepKernels& kernels_;
};

}  // namespace spherical_springs::core
