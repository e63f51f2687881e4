#include "stepping/layout.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "geometry/curve_order.h"
#include "stepping/cut.h"

namespace spherical_springs::core {

namespace {

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
    std::array<Shares, 5> shares;
    for (std::size_t sort = 0; sort < shares.size(); ++sort) {
      shares[sort] = cut_.share(lists[sort]);
    }
    reserve(shares, std::make_index_sequence<5>());
    for (std::size_t p = 0; p < cut_.patchCount(); ++p) {
      Patch patch = beginPatch(p);
      patch.groups = {fill<0>(lists, shares, p), fill<1>(lists, shares, p),
                      fill<2>(lists, shares, p), fill<3>(lists, shares, p),
                      fill<4>(lists, shares, p)};
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

  template <std::size_t... kSorts>
  void reserve(const std::array<Shares, 5>& shares, std::index_sequence<kSorts...>) {
    const auto groupCount = [&](const Shares& of) {
      std::size_t count = 0;
      for (std::size_t p = 0; p < cut_.patchCount(); ++p) {
        count += roundedUpToGroup(of.first[p + 1] - of.first[p]) / kGroup;
      }
      return count;
    };
    (std::get<kSorts>(layout_.groups_).reserve(groupCount(shares[kSorts])), ...);
  }

  template <class Spring, class Springs>
  void setSpring(std::uint32_t index, Springs& springs, std::uint32_t lane) const {
    const Spring& spring = system_.springs<Spring>()[index];
    springs.rest[lane] = spring.restValue();
    springs.stiffness[lane] = spring.stiffness;
  }

  template <int kEnds, int kSprings>
  void setElement(const Element& element, std::uint32_t lane,
                  ElementGroup<kEnds, kSprings>& group) {
    for (int i = 0; i < kEnds; ++i) {
      group.ends[i][lane] = offsetOf(element.ends[i]);
    }
    for (int i = 0; i < kSprings; ++i) {
      if (kEnds == 3 && i == 0) {
        setSpring<SolidAngleSpring>(element.springs[i], group.springs[i], lane);
      } else {
        setSpring<AngleSpring>(element.springs[i], group.springs[i], lane);
      }
    }
  }

  void setElement(const Element& element, std::uint32_t lane, OrientedArcs& group) {
    for (int i = 0; i < 3; ++i) group.ends[i][lane] = offsetOf(element.ends[i]);
    setSpring<OrientedAngleSpring>(element.springs[0], group, lane);
    group.width[lane] = effectiveWidth(system_.springs<OrientedAngleSpring>()[element.springs[0]]);
  }

  template <int kEnds, int kSprings>
  static void slacken(ElementGroup<kEnds, kSprings>& group, std::uint32_t lane) {
    for (auto& spring : group.springs) spring.stiffness[lane] = 0;
  }
  static void slacken(OrientedArcs& group, std::uint32_t lane) { group.stiffness[lane] = 0; }

  template <int kSort>
  GroupRange fill(const ElementLists& lists, const std::array<Shares, 5>& shares,
                  std::size_t patch) {
    using Group = typename std::tuple_element_t<kSort, GroupLists>::value_type;
    const std::uint32_t first = shares[kSort].first[patch];
    const std::uint32_t count = shares[kSort].first[patch + 1] - first;
    return appendGroups<Group>(
        count, std::get<kSort>(layout_.groups_),
        [&](std::uint32_t i, Group& group, std::uint32_t lane) {
          setElement(lists[kSort][shares[kSort].items[first + i]], lane, group);
        },
        [](Group& group, std::uint32_t lane) { slacken(group, lane); });
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
  std::vector<std::uint32_t> places(order_.size());
  for (std::uint32_t i = 0; i < places.size(); ++i) places[order_[i]] = i;
  Builder(*this, system, std::move(places)).build();
}

void Layout::updateGhosts(const Patch& patch, std::vector<Row>& rows) const {
  const std::uint32_t* const owned = ghosts_.data() + patch.first_ghost;
  const std::uint32_t first = patch.first_row + patch.slotCount();
  const std::uint32_t count = patch.row_count - patch.slotCount();
  for (std::uint32_t i = 0; i < count; ++i) rows[first + i] = rows[owned[i]];
}

std::size_t Layout::bytes() const {
  const auto of = [](const auto& list) { return list.size() * sizeof(list[0]); };
  const std::size_t groups =
      std::apply([&](const auto&... lists) { return (of(lists) + ...); }, groups_);
  return groups + of(order_) + of(ghosts_) + of(patches_);
}

}  // namespace spherical_springs::core
