#include "layout.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "../buckets.h"
#include "../curve_order.h"

namespace spherical_springs::core {

namespace {

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

  /// `endsOf(element)`: its ends.
  template <class Item, class EndsOf>
  Shares share(const std::vector<Item>& elements, const EndsOf& endsOf) const {
    return dealtOut<std::uint32_t>(
        patches_, [&](const auto& visit) { forEachShare(elements, endsOf, visit); });
  }

 private:
  template <class Item, class EndsOf, class Visitor>
  void forEachShare(const std::vector<Item>& elements, const EndsOf& endsOf,
                    const Visitor& visit) const {
    for (std::uint32_t e = 0; e < elements.size(); ++e) {
      std::array<std::uint32_t, 3> seen{kNone, kNone, kNone};
      std::size_t seen_count = 0;
      for (const std::uint32_t end : endsOf(elements[e])) {
        if (end == kNone) continue;
        const std::uint32_t patch = patch_of_[end];
        if (std::find(seen.begin(), seen.end(), patch) != seen.end()) continue;
        seen[seen_count++] = patch;
        visit(patch, e);
      }
    }
  }

  std::size_t places_, patches_;
  std::vector<std::uint32_t> patch_of_;
};

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
      shares[sort] = cut_.share(lists[sort], [](const Element& e) { return e.ends; });
    }
    reserve(shares, std::make_index_sequence<5>());
    for (std::size_t p = 0; p < cut_.patchCount(); ++p) {
      Patch patch = beginPatch(p);
      patch.groups = {fill<0>(lists, shares, p), fill<1>(lists, shares, p),
                      fill<2>(lists, shares, p), fill<3>(lists, shares, p),
                      fill<4>(lists, shares, p)};
      endPatch(patch);
    }
    namesOfGuests();
  }

 private:
  Patch beginPatch(std::size_t b) {
    Patch patch = {};
    patch.first_place = static_cast<std::uint32_t>(cut_.begin(b));
    patch.particle_count = static_cast<std::uint32_t>(cut_.begin(b + 1)) - patch.first_place;
    patch.first_slot = layout_.slot_count_;
    patch.first_row = layout_.row_count_;
    patch.first_guest = static_cast<std::uint32_t>(layout_.guests_.size());
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
    std::for_each(layout_.guests_.begin() + patch.first_guest, layout_.guests_.end(), none);
    layout_.patches_.push_back(patch);
  }

  /// The row in the present patch of a place in the order.
  std::uint32_t rowOf(std::uint32_t place) {
    if (row_of_[place] == kNone) {
      row_of_[place] = row_count_++;
      layout_.guests_.push_back(place);
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
        count += Patch::roundedUp(of.first[p + 1] - of.first[p]) / kGroup;
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

  /// Elements that the kernels take together lie far apart on the sphere, so that they do not wait
  /// for each other's forces.
  template <int kSort>
  Patch::Range fill(const ElementLists& lists, const std::array<Shares, 5>& shares,
                    std::size_t patch) {
    auto& groups = std::get<kSort>(layout_.groups_);
    const std::uint32_t first = shares[kSort].first[patch];
    const std::uint32_t count = shares[kSort].first[patch + 1] - first;
    const auto begin = static_cast<std::uint32_t>(groups.size());
    const std::uint32_t room = Patch::roundedUp(count), group_count = room / kGroup;
    layout_.most_elements_ = std::max(layout_.most_elements_, room);
    groups.resize(begin + group_count);
    for (std::uint32_t i = 0; i < room; ++i) {
      const std::uint32_t e = shares[kSort].items[first + std::min(i, count - 1)];
      auto& group = groups[begin + i % group_count];
      const std::uint32_t lane = i / group_count;
      setElement(lists[kSort][e], lane, group);
      if (i >= count) slacken(group, lane);
    }
    return {begin, begin + group_count};
  }

  /// From places in the order to rows at home.
  void namesOfGuests() {
    for (const Patch& patch : layout_.patches_) {
      for (std::uint32_t i = 0; i < patch.particle_count; ++i) {
        row_of_[patch.first_place + i] = patch.first_row + i;
      }
    }
    for (std::uint32_t& guest : layout_.guests_) guest = row_of_[guest];
    layout_.guests_.shrink_to_fit();
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

std::size_t Layout::bytes() const {
  const auto of = [](const auto& list) { return list.size() * sizeof(list[0]); };
  const std::size_t groups =
      std::apply([&](const auto&... lists) { return (of(lists) + ...); }, groups_);
  return groups + of(order_) + of(guests_) + of(patches_);
}

}  // namespace spherical_springs::core
