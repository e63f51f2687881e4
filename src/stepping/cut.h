// The order of particles cut into patches, and springs dealt out to them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/buckets.h"
#include "stepping/elements.h"

namespace spherical_springs::core {

/// Indices of the elements of each patch.
using Shares = Buckets<std::uint32_t>;

/// Places dealt out to patches, as evenly as can be.
class Cut {
 public:
  Cut(std::size_t places, std::size_t patches)
      : places_(places), patches_(patches), patch_of_(places) {
    for (std::size_t b = 0; b < patches; ++b) {
      std::fill(patch_of_.begin() + begin(b), patch_of_.begin() + begin(b + 1), b);
    }
  }
  std::size_t begin(std::size_t patch) const { return places_ * patch / patches_; }
  std::size_t patchCount() const { return patches_; }
  std::uint32_t patchOf(std::uint32_t place) const { return patch_of_[place]; }

  /// An element is in the share of each patch that has one of its ends.
  Shares share(const std::vector<Element>& elements) const {
    return dealtOut<std::uint32_t>(patches_,
                                   [&](const auto& visit) { forEachShare(elements, visit); });
  }

 private:
  template <class Visitor>
  void forEachShare(const std::vector<Element>& elements, const Visitor& visit) const {
    for (std::uint32_t e = 0; e < elements.size(); ++e) {
      std::array<std::uint32_t, kMostEnds> seen;
      std::size_t seen_count = 0;
      for (const std::uint32_t end : elements[e].ends) {
        if (end == kNone) continue;
        const std::uint32_t patch = patch_of_[end];
        const auto seen_end = seen.begin() + seen_count;
        if (std::find(seen.begin(), seen_end, patch) != seen_end) continue;
        seen[seen_count++] = patch;
        visit(patch, e);
      }
    }
  }

  std::size_t places_, patches_;
  std::vector<std::uint32_t> patch_of_;
};

}  // namespace spherical_springs::core
