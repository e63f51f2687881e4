#include "layout.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "particle_order.h"

namespace spherical_springs::core {

Elements ElementArrays::range(std::uint32_t begin, std::uint32_t end) const {
  Elements elements = {};
  for (int i = 0; i < end_count_; ++i) elements.ends[i] = ends_[i].data() + begin;
  for (int i = 0; i < spring_count_; ++i) {
    elements.springs[i] = {rest_[i].data() + begin, stiffness_[i].data() + begin};
  }
  elements.count = end - begin;
  return elements;
}

void ElementArrays::grow(std::uint32_t count) {
  for (int i = 0; i < end_count_; ++i) ends_[i].resize(count, 0);
  for (int i = 0; i < spring_count_; ++i) {
    rest_[i].resize(count, 0);
    stiffness_[i].resize(count, 0);
  }
}

void ElementArrays::set(std::uint32_t index, const std::array<std::uint32_t, 3>& rows,
                        const std::array<Constants, 3>& constants) {
  for (int i = 0; i < end_count_; ++i) {
    ends_[i][index] = static_cast<std::uint32_t>(kRowLength * rows[i]);
  }
  for (int i = 0; i < spring_count_; ++i) {
    rest_[i][index] = constants[i].rest;
    stiffness_[i][index] = constants[i].stiffness;
  }
}

std::size_t ElementArrays::bytes() const {
  const std::size_t each = end_count_ * sizeof(std::uint32_t) + spring_count_ * 2 * sizeof(double);
  return each * size();
}

namespace {

/// The elements of each patch: those of patch b are at [first[b], first[b + 1]).
struct Shares {
  std::vector<std::uint32_t> first, elements;
};

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

  /// `endsOf(e)`: the ends of each of `count` elements.
  template <class EndsOf>
  Shares share(std::uint32_t count, const EndsOf& endsOf) const {
    Shares shares{std::vector<std::uint32_t>(patches_ + 1, 0), {}};
    forEachPatch(count, endsOf, [&](std::uint32_t b, std::uint32_t) { ++shares.first[b + 1]; });
    for (std::size_t b = 0; b < patches_; ++b) shares.first[b + 1] += shares.first[b];
    shares.elements.resize(shares.first.back());
    std::vector<std::uint32_t> next(shares.first.begin(), shares.first.end() - 1);
    forEachPatch(count, endsOf,
                 [&](std::uint32_t b, std::uint32_t e) { shares.elements[next[b]++] = e; });
    return shares;
  }

 private:
  template <class EndsOf, class Visitor>
  void forEachPatch(std::uint32_t count, const EndsOf& endsOf, const Visitor& visit) const {
    for (std::uint32_t e = 0; e < count; ++e) {
      std::array<std::uint32_t, 3> seen{kNone, kNone, kNone};
      std::size_t seen_count = 0;
      for (const std::uint32_t end : endsOf(e)) {
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
    const auto share = [&](const std::vector<Element>& elements) {
      return cut_.share(static_cast<std::uint32_t>(elements.size()),
                        [&](std::uint32_t e) { return elements[e].ends; });
    };
    const Shares arcs = share(lists.arcs);
    const std::array<Shares, 3> triangles = {share(lists.triangles[0]), share(lists.triangles[1]),
                                             share(lists.triangles[2])};
    const auto oriented = orientedArcs();
    const Shares oriented_shares = cut_.share(static_cast<std::uint32_t>(oriented.size()),
                                              [&](std::uint32_t e) { return oriented[e].rows; });
    for (std::size_t b = 0; b < cut_.patchCount(); ++b) {
      Patch patch = beginPatch(b);
      patch.arcs = fill(lists.arcs, arcs, b, layout_.arcs_);
      for (int i = 0; i < 3; ++i) {
        patch.triangles[i] = fill(lists.triangles[i], triangles[i], b, layout_.triangles_[i]);
      }
      patch.oriented = fillOriented(oriented, oriented_shares, b);
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

  std::array<std::uint32_t, 3> rowsOf(const std::array<std::uint32_t, 3>& places) {
    std::array<std::uint32_t, 3> rows{};
    for (std::size_t i = 0; i < 3; ++i) {
      if (places[i] != kNone) rows[i] = rowOf(places[i]);
    }
    return rows;
  }

  template <class Spring>
  ElementArrays::Constants constantsOf(std::uint32_t index) const {
    if (index == kNone) return {0, 0};
    const Spring& spring = system_.springs<Spring>()[index];
    return {spring.restValue(), spring.stiffness};
  }

  /// Elements that the kernels take together lie far apart on the sphere, so that they do not wait
  /// for each other's torques.
  Patch::Range fill(const std::vector<Element>& elements, const Shares& shares, std::size_t b,
                    ElementArrays& arrays) {
    const std::uint32_t first = shares.first[b], count = shares.first[b + 1] - first;
    const std::uint32_t begin = arrays.size(), room = Patch::roundedUp(count);
    const std::uint32_t groups = room / kGroup;
    layout_.most_elements_ = std::max(layout_.most_elements_, room);
    arrays.grow(begin + room);
    for (std::uint32_t i = 0; i < room; ++i) {
      const Element& element = elements[shares.elements[first + std::min(i, count - 1)]];
      const auto arc = constantsOf<AngleSpring>(element.arc);
      std::array<ElementArrays::Constants, 3> constants = {
          arc, arc, constantsOf<AngleSpring>(element.second_arc)};
      if (element.triangle != kNone) {
        constants[0] = constantsOf<SolidAngleSpring>(element.triangle);
      }
      if (i >= count) {
        for (auto& constant : constants) constant.stiffness = 0;
      }
      arrays.set(begin + i % groups * kGroup + i / groups, rowsOf(element.ends), constants);
    }
    return {begin, begin + room};
  }

  /// Rows are places in the order as yet.
  std::vector<OrientedArc> orientedArcs() const {
    const auto& springs = system_.springs<OrientedAngleSpring>();
    std::vector<OrientedArc> arcs(springs.size());
    for (std::uint32_t s = 0; s < arcs.size(); ++s) {
      arcs[s].spring = s;
      for (std::size_t i = 0; i < 3; ++i) arcs[s].rows[i] = places_[springs[s].particles[i]];
    }
    const auto key = [&](const OrientedArc& arc) {
      const OrientedAngleSpring& spring = springs[arc.spring];
      return std::make_tuple(arc.rows, spring.rest_angle, spring.stiffness, spring.width);
    };
    std::sort(arcs.begin(), arcs.end(),
              [&](const OrientedArc& a, const OrientedArc& b) { return key(a) < key(b); });
    return arcs;
  }

  Patch::Range fillOriented(const std::vector<OrientedArc>& oriented, const Shares& shares,
                            std::size_t b) {
    const auto begin = static_cast<std::uint32_t>(layout_.oriented_.size());
    for (std::uint32_t i = shares.first[b]; i < shares.first[b + 1]; ++i) {
      const OrientedArc& arc = oriented[shares.elements[i]];
      layout_.oriented_.push_back({rowsOf(arc.rows), arc.spring});
    }
    return {begin, static_cast<std::uint32_t>(layout_.oriented_.size())};
  }

  /// From places in the order to rows at home.
  void namesOfGuests() {
    for (const Patch& patch : layout_.patches_) {
      for (std::uint32_t i = 0; i < patch.particle_count; ++i) {
        row_of_[patch.first_place + i] = patch.first_row + i;
      }
    }
    for (std::uint32_t& guest : layout_.guests_) guest = row_of_[guest];
  }

  Layout& layout_;
  const System& system_;
  std::vector<std::uint32_t> places_;
  Cut cut_;
  std::vector<std::uint32_t> row_of_;
  std::uint32_t row_count_ = 0;
};

Layout::Layout(const System& system, const Points& positions) : order_(particleOrder(positions)) {
  std::vector<std::uint32_t> places(order_.size());
  for (std::uint32_t i = 0; i < places.size(); ++i) places[order_[i]] = i;
  Builder(*this, system, std::move(places)).build();
}

std::size_t Layout::bytes() const {
  std::size_t elements = arcs_.bytes();
  for (const ElementArrays& triangles : triangles_) elements += triangles.bytes();
  return elements + order_.size() * sizeof(order_[0]) + guests_.size() * sizeof(guests_[0]) +
         patches_.size() * sizeof(Patch) + oriented_.size() * sizeof(OrientedArc);
}

}  // namespace spherical_springs::core
