#include "relaxation/group_units.h"

#include <algorithm>

namespace spherical_springs::core {

void GroupUnits::take(const System& system, const ParticleOrder& order, double least) {
  constexpr double kMuchSofter = 1e-3;
  if (group_.empty()) return;
  units_.assign(*std::max_element(group_.begin(), group_.end()) + 1, least);
  forEachKind([&](auto kind) {
    for (const auto& spring : system.springs<typename decltype(kind)::type>()) {
      for (const std::uint32_t i : spring.particles) {
        if (order.numbers[i] >= order.free_count) continue;
        double& unit = units_[group_[order.numbers[i]]];
        unit = std::max(unit, spring.stiffness);
      }
    }
  });
  const double largest = *std::max_element(units_.begin(), units_.end());
  if (shared_.empty()) {
    for (const double unit : units_) shared_.push_back(unit > kMuchSofter * largest);
  }
  differ_ = false;
  for (std::size_t g = 0; g < units_.size(); ++g) {
    if (shared_[g]) units_[g] = largest;
    differ_ = differ_ || units_[g] != largest;
  }
}

}  // namespace spherical_springs::core
