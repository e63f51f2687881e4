#include "system/groups.h"

#include "base/disjoint_sets.h"

namespace spherical_springs::core {
namespace {

constexpr std::uint32_t kNone = ~0u;

/// Joins the particles of a spring that `joins` allows.
template <class Spring, class Joins>
void joinEnds(const Spring& spring, const Joins& joins, DisjointSets& sets) {
  std::uint32_t first = kNone;
  for (const std::uint32_t particle : spring.particles) {
    if (!joins(particle)) continue;
    if (first == kNone) first = particle;
    sets.join(first, particle);
  }
}

}  // namespace

std::vector<std::uint32_t> groupsOf(const System& system, Pins pins) {
  DisjointSets sets(system.particleCount());
  const auto joins = [&](std::uint32_t i) { return pins == Pins::join || !system.pinned(i); };
  forEachKind([&](auto kind) {
    for (const auto& spring : system.springs<typename decltype(kind)::type>()) {
      joinEnds(spring, joins, sets);
    }
  });
  std::vector<std::uint32_t> number(system.particleCount());
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < number.size(); ++i) {
    if (sets.rootOf(i) == i) number[i] = count++;
  }
  for (std::uint32_t i = 0; i < number.size(); ++i) number[i] = number[sets.rootOf(i)];
  return number;
}

}  // namespace spherical_springs::core
