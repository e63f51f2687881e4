#include "stepping/layout.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "geometry/curve_order.h"
#include "stepping/cut.h"

namespace spherical_springs::core {

namespace {

template <class Spring, class Springs>
void takeNumbersOf(const Spring& spring, Springs& springs, std::uint32_t lane) {
  springs.rest[lane] = spring.restValue();
  springs.stiffness[lane] = spring.stiffness;
}

// The overloads below copy the numbers of the springs of an element into its lane of a group.

void takeNumbersOf(const System& system, const SpringIndices<Arcs>& indices, std::uint32_t lane,
                   Arcs& group) {
  takeNumbersOf(system.springs<AngleSpring>()[indices.of[0][lane]], group.springs[0], lane);
}

template <int kSprings>
void takeNumbersOf(const System& system, const SpringIndices<ElementGroup<3, kSprings>>& indices,
                   std::uint32_t lane, ElementGroup<3, kSprings>& group) {
  takeNumbersOf(system.springs<SolidAngleSpring>()[indices.of[0][lane]], group.springs[0], lane);
  for (int i = 1; i < kSprings; ++i) {
    takeNumbersOf(system.springs<AngleSpring>()[indices.of[i][lane]], group.springs[i], lane);
  }
}

void takeNumbersOf(const System& system, const SpringIndices<OrientedArcs>& indices,
                   std::uint32_t lane, OrientedArcs& group) {
  const OrientedAngleSpring& spring = system.springs<OrientedAngleSpring>()[indices.of[0][lane]];
  takeNumbersOf(spring, group.springs[0], lane);
  group.width[lane] = effectiveWidth(spring);
}

template <class Spring>
void takeNumbersOf(const System& system, const SpringIndices<PlainSprings<Spring>>& indices,
                   std::uint32_t lane, PlainSprings<Spring>& group) {
  group.springs[lane] = system.springs<Spring>()[indices.of[0][lane]];
}

template <int kEnds, int kSprings>
void slacken(ElementGroup<kEnds, kSprings>& group, std::uint32_t lane) {
  for (auto& spring : group.springs) spring.stiffness[lane] = 0;
}

template <class Spring>
void slacken(PlainSprings<Spring>& group, std::uint32_t lane) {
  group.springs[lane].stiffness = 0;
}

/// Few enough that positions and torques stay in the cache next to the processor.
std::size_t patchCountFor(std::size_t particles) {
  constexpr std::size_t kParticles = 1024, kEven = 4;
  if (particles <= kParticles) return 1;
  return ((particles + kParticles - 1) / kParticles + kEven - 1) / kEven * kEven;
}

}  // namespace

/// Fills a layout patch by patch.
class Layout::Builder {
 public:
  Builder(Layout& layout, const System& system, std::vector<std::uint32_t> places)
      : layout_(layout),
        system_(system),
        places_(std::move(places)),
        cut_(places_.size(), patchCountFor(places_.size())),
        row_of_(places_.size(), kNone) {}

  void build() {
    const ElementLists lists = elementsOf(system_, places_);
    layout_.any_parallel_ = lists.any_parallel;
    std::array<Shares, kSortCount> shares;
    for (std::size_t sort = 0; sort < kSortCount; ++sort) {
      shares[sort] = cut_.share(lists.of[sort]);
    }
    forEachSort([&](auto sort) { reserve(sort, shares); });
    for (std::size_t p = 0; p < cut_.patchCount(); ++p) {
      Patch patch = beginPatch(p);
      forEachSort([&](auto sort) { fill(sort, lists, shares, p, patch); });
      endPatch(patch);
    }
    nameGhosts();
  }

 private:
  Patch beginPatch(std::size_t b) {
    Patch patch = {};
    patch.first_place = static_cast<std::uint32_t>(cut_.begin(b));
    patch.particle_count = static_cast<std::uint32_t>(cut_.begin(b + 1)) - patch.first_place;
    patch.first_slot = layout_.slot_count_;
    patch.first_row = layout_.row_count_;
    patch.first_ghost = static_cast<std::uint32_t>(layout_.ghosts_.size());
    for (std::uint32_t i = 0; i < patch.particle_count; ++i) row_of_[patch.first_place + i] = i;
    row_count_ = patch.slotCount();
    return patch;
  }

  void endPatch(Patch& patch) {
    patch.row_count = row_count_;
    layout_.slot_count_ += patch.slotCount();
    layout_.row_count_ += patch.row_count;
    layout_.largest_patch_ = std::max(layout_.largest_patch_, patch.row_count);
    const auto none = [&](std::uint32_t place) { row_of_[place] = kNone; };
    for (std::uint32_t i = 0; i < patch.particle_count; ++i) none(patch.first_place + i);
    std::for_each(layout_.ghosts_.begin() + patch.first_ghost, layout_.ghosts_.end(), none);
    layout_.patches_.push_back(patch);
  }

  /// The row in the present patch of a place in the order.
  std::uint32_t rowOf(std::uint32_t place) {
    if (row_of_[place] == kNone) {
      row_of_[place] = row_count_++;
      layout_.ghosts_.push_back(place);
    }
    return row_of_[place];
  }

  std::uint32_t offsetOf(std::uint32_t place) {
    return static_cast<std::uint32_t>(kRowLength * rowOf(place));
  }

  template <class Group>
  void reserve(Kind<Group>, const std::array<Shares, kSortCount>& shares) {
    const std::vector<std::uint32_t>& first = shares[sortOf<Group>()].first;
    std::size_t count = 0;
    for (std::size_t p = 0; p < cut_.patchCount(); ++p) {
      count += roundedUpToGroup(first[p + 1] - first[p]) / kGroup;
    }
    std::get<GroupList<Group>>(layout_.groups_).reserve(count);
    std::get<IndexList<Group>>(layout_.springs_).reserve(count);
  }

  /// Puts an element into a lane: its ends, and the numbers and indices of its springs.
  template <class Group>
  void setElement(const Element& element, std::uint32_t lane, Group& group,
                  SpringIndices<Group>& indices) {
    for (std::size_t i = 0; i < std::size(group.ends); ++i) {
      group.ends[i][lane] = offsetOf(element.ends[i]);
    }
    for (int i = 0; i < Group::kSpringsOfOne; ++i) indices.of[i][lane] = element.springs[i];
    takeNumbersOf(system_, indices, lane, group);
  }

  template <class Group>
  void fill(Kind<Group>, const ElementLists& lists, const std::array<Shares, kSortCount>& shares,
            std::size_t p, Patch& patch) {
    constexpr std::size_t kSort = sortOf<Group>();
    auto& groups = std::get<GroupList<Group>>(layout_.groups_);
    auto& indices = std::get<IndexList<Group>>(layout_.springs_);
    const std::uint32_t first = shares[kSort].first[p];
    const std::uint32_t count = shares[kSort].first[p + 1] - first;
    indices.resize(groups.size() + roundedUpToGroup(count) / kGroup);
    const auto indicesOf = [&](Group& group) -> SpringIndices<Group>& {
      return indices[&group - groups.data()];
    };
    patch.groups[kSort] = appendGroups<Group>(
        count, groups,
        [&](std::uint32_t i, Group& group, std::uint32_t lane) {
          setElement(lists.of[kSort][shares[kSort].items[first + i]], lane, group,
                     indicesOf(group));
        },
        [&](Group& group, std::uint32_t lane) {
          slacken(group, lane);
          indicesOf(group).of[0][lane] = kNone;
        });
  }

  /// Turns ghosts from places in the order into owned rows.
  void nameGhosts() {
    for (const Patch& patch : layout_.patches_) {
      for (std::uint32_t i = 0; i < patch.particle_count; ++i) {
        row_of_[patch.first_place + i] = patch.first_row + i;
      }
    }
    for (std::uint32_t& ghost : layout_.ghosts_) ghost = row_of_[ghost];
    layout_.ghosts_.shrink_to_fit();
  }

  Layout& layout_;
  const System& system_;
  std::vector<std::uint32_t> places_;
  Cut cut_;
  std::vector<std::uint32_t> row_of_;
  std::uint32_t row_count_ = 0;
};

Layout::Layout(const System& system, const Points& positions) : order_(curveOrder(positions)) {
  build(system);
}

Layout::Layout(const Layout& earlier, const System& system) {
  if (earlier.any_parallel_) {
    order_ = earlier.order_;
    build(system);
  } else {
    *this = earlier;
    takeNumbers(system);
  }
}

void Layout::build(const System& system) {
  std::vector<std::uint32_t> places(order_.size());
  for (std::uint32_t i = 0; i < places.size(); ++i) places[order_[i]] = i;
  Builder(*this, system, std::move(places)).build();
}

void Layout::takeNumbers(const System& system) {
  forEachSort([&](auto sort) {
    using Group = typename decltype(sort)::type;
    auto& groups = std::get<GroupList<Group>>(groups_);
    const auto& indices = std::get<IndexList<Group>>(springs_);
    for (std::size_t g = 0; g < groups.size(); ++g) {
      for (std::uint32_t lane = 0; lane < kGroup; ++lane) {
        if (indices[g].of[0][lane] == kNone) continue;
        takeNumbersOf(system, indices[g], lane, groups[g]);
      }
    }
  });
}

void Layout::updateGhosts(const Patch& patch, std::vector<Row>& rows) const {
  const std::uint32_t* const owned = ghosts_.data() + patch.first_ghost;
  const std::uint32_t first = patch.first_row + patch.slotCount();
  const std::uint32_t count = patch.row_count - patch.slotCount();
  for (std::uint32_t i = 0; i < count; ++i) rows[first + i] = rows[owned[i]];
}

std::size_t Layout::bytes() const {
  const auto of = [](const auto& list) { return list.size() * sizeof(list[0]); };
  const auto ofAll = [&](const auto&... lists) { return (of(lists) + ...); };
  return std::apply(ofAll, groups_) + std::apply(ofAll, springs_) + of(order_) + of(ghosts_) +
         of(patches_);
}

}  // namespace spherical_springs::core
