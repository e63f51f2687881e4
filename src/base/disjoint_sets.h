#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace spherical_springs::core {

/// A partition of the numbers below a count, each alone at first.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count = 0) : parents_(count) {
    std::iota(parents_.begin(), parents_.end(), 0u);
  }

  /// Grows to a larger count.
  void growTo(std::size_t count) {
    while (parents_.size() < count) parents_.push_back(static_cast<std::uint32_t>(parents_.size()));
  }

  /// Makes a number its own root, when the others of its set are too.
  void separate(std::uint32_t i) { parents_[i] = i; }

  /// Returns the number that stands for the set of `i`.
  std::uint32_t rootOf(std::uint32_t i) {
    while (parents_[i] != i) {
      parents_[i] = parents_[parents_[i]];
      i = parents_[i];
    }
    return i;
  }

  void join(std::uint32_t i, std::uint32_t j) { parents_[rootOf(j)] = rootOf(i); }

 private:
  std::vector<std::uint32_t> parents_;
};

}  // namespace spherical_springs::core
