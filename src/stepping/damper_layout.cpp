#include "stepping/damper_layout.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "stepping/cut.h"
#include "stepping/elements.h"

namespace spherical_springs::core {

/// Fills a layout of dampers kind by kind.
class DamperLayout::Builder {
 public:
  Builder(DamperLayout& dampers, const System& system, const Layout& layout)
      : dampers_(dampers),
        system_(system),
        layout_(layout),
        cut_(layout.order().size(), layout.patches().size()),
        places_(layout.order().size()),
        home_(layout.order().size()),
        row_of_(layout.rowCount()) {
    for (std::uint32_t i = 0; i < places_.size(); ++i) places_[layout.order()[i]] = i;
    for (const Patch& patch : layout.patches()) {
      std::iota(home_.begin() + patch.first_place,
                home_.begin() + patch.first_place + patch.particle_count, patch.first_row);
    }
    elements_ = dampedElementsOf(system, places_);
    dampers.shares_.resize(layout.patches().size());
  }

  template <class Spring>
  void fill() {
    const std::vector<Element>& elements = elements_.get<Spring>();
    Shares shares = cut_.share(elements);
    for (std::uint32_t p = 0; p < shares_.size(); ++p) {
      const auto begin = shares.begin(p), end = shares.end(p);
      const auto inner_end =
          std::stable_partition(begin, end, [&](std::uint32_t e) { return isInner(elements[e]); });
      DamperShare<Spring>& share = shares_[p].template get<Spring>();
      share.inner = static_cast<std::uint32_t>(inner_end - begin);
      share.groups = append<Spring>(p, begin, static_cast<std::uint32_t>(end - begin), elements);
      for (auto i = inner_end; i != end; ++i) {
        if (patchOfFirst(elements[*i]) != p) continue;
        addShared<Spring>(elements[*i], share.groups, static_cast<std::uint32_t>(i - begin));
      }
    }
  }

 private:
  std::uint32_t patchOfFirst(const Element& element) const { return cut_.patchOf(element.ends[0]); }

  bool isInner(const Element& element) const {
    return std::all_of(element.ends.begin(), element.ends.end(), [&](std::uint32_t end) {
      return end == kNone || cut_.patchOf(end) == patchOfFirst(element);
    });
  }

  /// Makes `row_of_` the map from owned rows to rows in a patch.
  void enter(const Patch& patch) {
    const auto own = row_of_.begin() + patch.first_row;
    std::iota(own, own + patch.particle_count, 0);
    for (std::uint32_t row = patch.slotCount(); row < patch.row_count; ++row) {
      row_of_[layout_.ghosts()[patch.first_ghost + row - patch.slotCount()]] = row;
    }
  }

  template <class Spring>
  GroupRange append(std::uint32_t patch, std::vector<std::uint32_t>::const_iterator share,
                    std::uint32_t count, const std::vector<Element>& elements) {
    enter(layout_.patches()[patch]);
    using Group = DampersOf<Spring>;
    return appendGroups<Group>(
        count, dampers_.groups_.get<Spring>(),
        [&](std::uint32_t i, Group& group, std::uint32_t lane) {
          setElement<Spring>(elements[share[i]], lane, group);
        },
        [](Group& group, std::uint32_t lane) { group.root_coefficient[lane] = 0; });
  }

  template <class Spring>
  void setElement(const Element& element, std::uint32_t lane, DampersOf<Spring>& group) const {
    const Spring& spring = system_.springs<Spring>()[element.springs[0]];
    for (int i = 0; i < group.kEnds; ++i) {
      const std::uint32_t place = element.ends[i];
      group.ends[i][lane] = static_cast<std::uint32_t>(kRowLength * row_of_[home_[place]]);
      group.root_mobility[i][lane] = std::sqrt(system_.inverseMasses()[layout_.order()[place]]);
    }
    group.root_coefficient[lane] = std::sqrt(spring.damping);
    if constexpr (std::is_same_v<Spring, OrientedAngleSpring>) {
      group.width[lane] = effectiveWidth(spring);
    } else if constexpr (!kHasStepKernels<Spring>) {
      group.springs[lane] = spring;
    }
  }

  template <class Spring>
  void addShared(const Element& element, const GroupRange& groups, std::uint32_t index) {
    SharedDamper shared = {groups.groupOf(index), groups.laneOf(index), {}};
    for (std::size_t i = 0; i < Spring::kParticles; ++i) shared.rows[i] = home_[element.ends[i]];
    dampers_.shared_.get<Spring>().push_back(shared);
  }

  DamperLayout& dampers_;
  const System& system_;
  const Layout& layout_;
  Cut cut_;
  std::vector<std::uint32_t> places_;  // of particles
  std::vector<std::uint32_t> home_;    // rows of places
  std::vector<std::uint32_t> row_of_;  // in the present patch, by owned row
  PerKind<DampedElements> elements_;
  std::vector<PerKind<DamperShare>>& shares_ = dampers_.shares_;
};

DamperLayout::DamperLayout(const System& system, const Layout& layout) {
  Builder builder(*this, system, layout);
  forEachKind([&](auto kind) { builder.fill<typename decltype(kind)::type>(); });
}

}  // namespace spherical_springs::core
