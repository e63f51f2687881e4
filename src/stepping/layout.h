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

/// Elements of each sort, in the order of `ElementLists`.
using GroupLists = std::tuple<GroupList<Arcs>, GroupList<Triangles<0>>, GroupList<Triangles<1>>,
                              GroupList<Triangles<2>>, GroupList<OrientedArcs>>;

/// About a thousand particles that are stepped together, and the springs that pull at them. A
/// spring between patches is in each patch that owns one of its ends; particles of other patches
/// that its springs need are ghosts, copies of the rows that their own patches step.
struct Patch {
  std::uint32_t first_place, particle_count;  ///< in the order
  std::uint32_t first_slot;                   ///< of its particles, in arrays over particles
  std::uint32_t first_row, row_count;         ///< of its own particles, then of ghosts
  std::uint32_t first_ghost;                  ///< in the list of ghosts

  std::array<GroupRange, 5> groups;  ///< of each sort

  std::uint32_t slotCount() const { return roundedUpToGroup(particle_count); }
};

class Layout {
 public:
  /// `positions`: where the particles are, or were, so that neighbours come to lie together.
  Layout(const System& system, const Points& positions);

  const std::vector<std::uint32_t>& order() const { return order_; }
  const std::vector<Patch>& patches() const { return patches_; }
  std::uint32_t slotCount() const { return slot_count_; }
  std::uint32_t rowCount() const { return row_count_; }
  std::uint32_t largestPatch() const { return largest_patch_; }  ///< [rows]

  /// For each ghost, the row of the owned copy.
  const std::vector<std::uint32_t>& ghosts() const { return ghosts_; }
  const GroupLists& groups() const { return groups_; }

  /// Copies the owned rows of a patch's ghosts to the rows that these have in the patch.
  void updateGhosts(const Patch& patch, std::vector<Row>& rows) const;

  std::size_t bytes() const;

 private:
  class Builder;

  std::vector<std::uint32_t> order_;
  std::vector<Patch> patches_;
  std::uint32_t slot_count_ = 0, row_count_ = 0, largest_patch_ = 0;
  std::vector<std::uint32_t> ghosts_;
  GroupLists groups_;
};

}  // namespace spherical_springs::core
