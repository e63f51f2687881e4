// Particles and springs where the kernels want them.
#pragma once

#include <array>
#include <cstdint>
#include <tuple>
#include <vector>

#include "spherical_springs/system.h"
#include "stepping/elements.h"
#include "stepping/groups.h"
#include "stepping/step_kernels.h"

namespace spherical_springs::core {

template <class Group>
struct GroupList : std::vector<Group> {
  using std::vector<Group>::vector;
};

/// Indices in the system of the springs of a group; kNone in lanes left over.
template <class Group>
struct SpringIndices {
  std::uint32_t of[Group::kSpringsOfOne][kGroup];
};
template <class Group>
struct IndexList : std::vector<SpringIndices<Group>> {};

template <template <class> class List, class Sorts>
struct PerSortOf;
template <template <class> class List, class... Groups>
struct PerSortOf<List, std::tuple<Groups...>> {
  using type = std::tuple<List<Groups>...>;
};

/// One list for each of the `Sorts`.
template <template <class> class List>
using PerSort = typename PerSortOf<List, Sorts>::type;

/// About a thousand particles that are stepped together, and the springs that pull at them. A
/// spring between patches is in each patch that owns one of its ends; particles of other patches
/// that its springs need are ghosts, copies of the rows that their own patches step.
struct Patch {
  std::uint32_t first_place, particle_count;  ///< in the order
  std::uint32_t first_slot;                   ///< of its particles, in arrays over particles
  std::uint32_t first_row, row_count;         ///< of its own particles, then of ghosts
  std::uint32_t first_ghost;                  ///< in the list of ghosts

  std::array<GroupRange, kSortCount> groups;  ///< of each sort

  std::uint32_t slotCount() const { return roundedUpToGroup(particle_count); }
};

namespace detail {

// The overloads below call `visit(kind, index in the system)` for the springs of an element.

template <class Visitor>
void forEachSpringOf(const SpringIndices<Arcs>& springs, std::uint32_t lane, const Visitor& visit) {
  visit(Kind<AngleSpring>(), springs.of[0][lane]);
}

template <int kSprings, class Visitor>
void forEachSpringOf(const SpringIndices<ElementGroup<3, kSprings>>& springs, std::uint32_t lane,
                     const Visitor& visit) {
  visit(Kind<SolidAngleSpring>(), springs.of[0][lane]);
  for (int i = 1; i < kSprings; ++i) visit(Kind<AngleSpring>(), springs.of[i][lane]);
}

template <class Visitor>
void forEachSpringOf(const SpringIndices<OrientedArcs>& springs, std::uint32_t lane,
                     const Visitor& visit) {
  visit(Kind<OrientedAngleSpring>(), springs.of[0][lane]);
}

template <class Spring, class Visitor>
void forEachSpringOf(const SpringIndices<PlainSprings<Spring>>& springs, std::uint32_t lane,
                     const Visitor& visit) {
  visit(Kind<Spring>(), springs.of[0][lane]);
}

}  // namespace detail

class Layout {
 public:
  /// `positions`: where the particles are, or were, so that neighbours come to lie together.
  Layout(const System& system, const Points& positions);

  /// The layout of a system that differs from that of `earlier` in the numbers of its particles and
  /// springs alone, in the same order.
  Layout(const Layout& earlier, const System& system);

  const std::vector<std::uint32_t>& order() const { return order_; }
  const std::vector<Patch>& patches() const { return patches_; }
  std::uint32_t slotCount() const { return slot_count_; }
  std::uint32_t rowCount() const { return row_count_; }
  std::uint32_t largestPatch() const { return largest_patch_; }  ///< [rows]

  /// For each ghost, the row of the owned copy.
  const std::vector<std::uint32_t>& ghosts() const { return ghosts_; }
  const PerSort<GroupList>& groups() const { return groups_; }

  /// Calls `visit(kind, index in the system)` for the springs of an element of a patch.
  template <class Group, class Visitor>
  void forEachSpringOf(Kind<Group>, const Patch& patch, std::uint32_t element,
                       const Visitor& visit) const;

  /// Copies the owned rows of a patch's ghosts to the rows that these have in the patch.
  void updateGhosts(const Patch& patch, std::vector<Row>& rows) const;

  std::size_t bytes() const;

 private:
  class Builder;

  void build(const System& system);
  void takeNumbers(const System& system);

  std::vector<std::uint32_t> order_;
  std::vector<Patch> patches_;
  std::uint32_t slot_count_ = 0, row_count_ = 0, largest_patch_ = 0;
  std::vector<std::uint32_t> ghosts_;
  PerSort<GroupList> groups_;
  PerSort<IndexList> springs_;
  bool any_parallel_ = false;  // springs, whose order depends on their numbers
};

template <class Group, class Visitor>
void Layout::forEachSpringOf(Kind<Group>, const Patch& patch, std::uint32_t element,
                             const Visitor& visit) const {
  const std::uint32_t group = patch.groups[sortOf<Group>()].begin + element / kGroup;
  const std::uint32_t lane = element % kGroup;
  const auto& springs = std::get<IndexList<Group>>(springs_)[group];
  if (springs.of[0][lane] != kNone) detail::forEachSpringOf(springs, lane, visit);
}

}  // namespace spherical_springs::core
