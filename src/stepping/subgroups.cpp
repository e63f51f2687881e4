// How steps of a group are divided into those of its subgroups.
#include <algorithm>

#include "stepping/passages.h"

namespace spherical_springs::core {
namespace {

constexpr std::uint32_t kNone = ~0u;

/// Turns counts into the positions where each begins.
template <class Subgroups, class Begin, class End>
void placeAfterAnother(Subgroups& subgroups, Begin begin, End end) {
  std::uint32_t next = 0;
  for (auto& one : subgroups) {
    const std::uint32_t count = one.*end;
    one.*begin = one.*end = next;
    next += count;
  }
}

}  // namespace

void Passages::Level::begin(const SpringGroup& group, const Part& part) {
  demands.assign(part.springCount(), Demand::none);
  is_stiff.assign(part.springCount(), false);
  fresh.clear();
  subgroups.clear();
  positions.clear();
  angular_velocities.clear();
  // The last one tells that all of them are large enough.
  const std::size_t count = group.positions.size();
  if (is_changed.size() < count) {
    sets.growTo(count);
    subgroup_of.resize(count);
    torques.resize(count);
    for (auto* flags : {&leads, &is_divided, &is_changed}) flags->resize(count);
  }
  for (auto p = part.particles; p != part.particles_end; ++p) {
    positions.push_back(group.positions[*p]);
    angular_velocities.push_back(group.angular_velocities[*p]);
    is_divided[*p] = false;
    is_changed[*p] = true;
  }
}

void Passages::Level::putBackVelocities(SpringGroup& group, const Part& part) const {
  for (std::size_t i = 0; i < part.particleCount(); ++i) {
    group.angular_velocities[part.particles[i]] = entered[i];
  }
}

/// Puts changed particles back where the step began.
void Passages::Level::putBackChanged(SpringGroup& group, const Part& part) const {
  for (std::size_t i = 0; i < part.particleCount(); ++i) {
    const std::uint32_t p = part.particles[i];
    if (!is_changed[p]) continue;
    group.positions[p] = positions[i];
    group.angular_velocities[p] = angular_velocities[i];
  }
}

/// Finds the subgroups that springs which ask, and those that follow, make of their particles.
void Passages::divide(const SpringGroup& group, const Part& part, Level& level) {
  addFollowers(group, part, level);
  joinParticles(group, part, level);
  listSubgroups(group, part, level);
  level.fresh.clear();
}

/// Lets springs follow those that share particles with them and want it.
void Passages::addFollowers(const SpringGroup& group, const Part& part, Level& level) {
  const auto leads = [&](std::uint32_t s) { return level.demands[s] == Demand::with_neighbours; };
  if (std::none_of(level.fresh.begin(), level.fresh.end(), leads)) return;
  for (auto p = part.particles; p != part.particles_end; ++p) level.leads[*p] = false;
  for (const std::uint32_t s : level.fresh) {
    if (!leads(s)) continue;
    group.forEachFreeEnd(part.springs[s], [&](std::uint32_t p) { level.leads[p] = true; });
  }
  for (std::uint32_t s = 0; s < part.springCount(); ++s) {
    if (level.demands[s] != Demand::none) continue;
    group.forEachFreeEnd(part.springs[s], [&](std::uint32_t p) {
      if (level.leads[p]) level.demands[s] = Demand::follows;
    });
    if (level.demands[s] == Demand::follows) level.fresh.push_back(s);
  }
}

void Passages::joinParticles(const SpringGroup& group, const Part& part, Level& level) {
  for (auto p = part.particles; p != part.particles_end; ++p) {
    level.is_divided[*p] = false;
    level.sets.separate(*p);
    level.subgroup_of[*p] = kNone;
  }
  for (std::uint32_t s = 0; s < part.springCount(); ++s) {
    if (level.demands[s] == Demand::none) continue;
    std::uint32_t first = kNone;
    group.forEachFreeEnd(part.springs[s], [&](std::uint32_t p) {
      level.is_divided[p] = true;
      if (first == kNone) first = p;
      level.sets.join(first, p);
    });
  }
}

void Passages::listSubgroups(const SpringGroup& group, const Part& part, Level& level) {
  const auto subgroupAt = [&](std::uint32_t particle) -> Subgroup& {
    return level.subgroups[level.subgroup_of[level.sets.rootOf(particle)]];
  };
  const auto subgroupOf = [&](std::uint32_t s) -> Subgroup& {
    std::uint32_t end = kNone;
    group.forEachFreeEnd(part.springs[s], [&](std::uint32_t p) { end = p; });
    return subgroupAt(end);
  };
  level.subgroups.clear();
  std::uint32_t particle_count = 0, spring_count = 0;
  for (auto p = part.particles; p != part.particles_end; ++p) {
    if (!level.is_divided[*p]) continue;
    std::uint32_t& number = level.subgroup_of[level.sets.rootOf(*p)];
    if (number == kNone) {
      number = static_cast<std::uint32_t>(level.subgroups.size());
      level.subgroups.push_back({});
    }
    ++level.subgroups[number].particle_end;
    ++particle_count;
  }
  for (std::uint32_t s = 0; s < part.springCount(); ++s) {
    if (level.demands[s] == Demand::none) continue;
    ++subgroupOf(s).spring_end;
    ++spring_count;
  }
  for (const std::uint32_t s : level.fresh) subgroupOf(s).is_changed = true;
  placeAfterAnother(level.subgroups, &Subgroup::particle_begin, &Subgroup::particle_end);
  placeAfterAnother(level.subgroups, &Subgroup::spring_begin, &Subgroup::spring_end);
  level.particles.resize(particle_count);
  level.springs.resize(spring_count);
  for (auto p = part.particles; p != part.particles_end; ++p) {
    level.is_changed[*p] = level.is_divided[*p] && subgroupAt(*p).is_changed;
    if (level.is_divided[*p]) level.particles[subgroupAt(*p).particle_end++] = *p;
  }
  for (std::uint32_t s = 0; s < part.springCount(); ++s) {
    if (level.demands[s] == Demand::none) continue;
    level.springs[subgroupOf(s).spring_end++] = part.springs[s];
  }
}

}  // namespace spherical_springs::core
