#pragma once

#include <cstdint>
#include <optional>

#include "spherical_springs/system.h"

namespace spherical_springs::core {

/// Keeps triangles of solid-angle springs from folding: one that is oriented as its rest angle
/// asks, or any that asks for none, must not come to be oriented the other way, at the end of a
/// move or on the way.
class OrientationGuard {
 public:
  /// `system` must live longer.
  explicit OrientationGuard(const System& system) : system_(system) {}

  /// Columns of both are particles in the order of their ids; each goes straight from `points`
  /// along its column of `moves`, all at the same pace, and back onto the sphere along its radius.
  /// @return the share of the moves, up to 1, that no triangle forbids. Triangles that are cut
  /// short raise `hold` of their particles to the inverse of their own share, less 1.
  double allowedShare(const Points& points, const Points& moves, Eigen::VectorXd& hold);

  /// The triangle that last allowed the least, by its place in the order of ids; none where all
  /// moves were allowed.
  const std::optional<std::size_t>& tightest() const { return tightest_; }

 private:
  const System& system_;
  std::optional<std::size_t> tightest_;
};

}  // namespace spherical_springs::core
