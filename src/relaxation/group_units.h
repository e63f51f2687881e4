// Units in which the energies of a system's groups are of about one size.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "relaxation/particle_order.h"

namespace spherical_springs::core {

/// For each group of free particles a unit of energy: the largest stiffness among its springs.
/// Groups that are softer than the stiffest one by less than a factor of 1000, when they are first
/// seen, have its unit.
class GroupUnits {
 public:
  /// `group`: of each free particle, by its number, from 0.
  explicit GroupUnits(std::vector<std::uint32_t> group) : group_(std::move(group)) {}

  /// Finds the units for a system; none is below `least` [J].
  void take(const System& system, const ParticleOrder& order, double least);

  double of(std::size_t free) const { return units_[group_[free]]; }  ///< [J]

  /// Whether not all units are the same.
  bool differ() const { return differ_; }

 private:
  std::vector<std::uint32_t> group_;
  std::vector<double> units_;
  std::vector<bool> shared_;  // whether a group has the unit of the stiffest one
  bool differ_ = false;
};

}  // namespace spherical_springs::core
