// The groups of particles that are stepped past places without derivative.
#include <algorithm>
#include <array>

#include "base/parallel.h"
#include "stepping/encounters.h"

namespace spherical_springs::core {
namespace {

/// A spring by the places of its ends in the order of the layout.
template <class Spring>
struct Placed {
  std::array<std::uint32_t, Spring::kParticles> ends;
  std::uint32_t index;
};

}  // namespace

void Encounters::joinParticles() {
  forEachIn(left_out_, [&](const auto& spring, std::uint32_t) {
    for (const std::uint32_t p : spring.particles) {
      sets_.separate(p);
      group_of_[p] = kNoGroup;
      is_changed_[p] = false;
    }
  });
  forEachIn(left_out_, [&](const auto& spring, std::uint32_t) {
    std::uint32_t first = kNoGroup;
    for (const std::uint32_t p : spring.particles) {
      if (!isFree(p)) continue;
      if (first == kNoGroup) first = p;
      sets_.join(first, p);
    }
  });
}

/// Returns the group of a spring left out, a new one where it is the first of it.
template <class Spring>
Encounters::Group& Encounters::groupOf(const Spring& spring) {
  const auto free = std::find_if(spring.particles.begin(), spring.particles.end(),
                                 [&](std::uint32_t p) { return isFree(p); });
  std::uint32_t& number = group_of_[sets_.rootOf(*free)];
  if (number == kNoGroup) {
    number = static_cast<std::uint32_t>(group_count_++);
    if (groups_.size() < group_count_) groups_.emplace_back();
    if (passages_.size() < group_count_) passages_.emplace_back();
    groups_[number].clear();
  }
  return groups_[number];
}

/// Sorts springs by the places of their ends and, where those are the same, by their numbers.
template <class Spring>
void Encounters::sortLeftOut(const std::vector<std::uint32_t>& places) {
  const auto& springs = system_.springs<Spring>();
  std::vector<std::uint32_t>& left_out = left_out_.get<Spring>();
  std::vector<Placed<Spring>> placed;
  placed.reserve(left_out.size());
  for (const std::uint32_t index : left_out) {
    placed.push_back({turned(springs[index], places).particles, index});
    for (std::uint32_t& end : placed.back().ends) end = places[end];
  }
  std::sort(placed.begin(), placed.end(), [&](const auto& a, const auto& b) {
    if (a.ends != b.ends) return a.ends < b.ends;
    return fieldsOf(springs[a.index]) < fieldsOf(springs[b.index]);
  });
  for (std::size_t i = 0; i < placed.size(); ++i) left_out[i] = placed[i].index;
}

/// A group is what springs left out join by particles that are free.
void Encounters::makeGroups(const std::vector<std::uint32_t>& places) {
  forEachKind([&](auto kind) { sortLeftOut<typename decltype(kind)::type>(places); });
  joinParticles();
  group_count_ = 0;
  forEachIn(left_out_, [&](auto spring, std::uint32_t id) {
    Group& group = groupOf(spring);
    spring = turned(spring, places);
    for (std::uint32_t& p : spring.particles) p = placeIn(group, p);
    group.springs.emplace_back(spring);
    group.ids.push_back(id);
  });
  forEachIn(fresh_, [&](const auto& spring, std::uint32_t) { groupOf(spring).is_changed = true; });
  forEachKind([&](auto kind) { fresh_.get<typename decltype(kind)::type>().clear(); });
  for (std::size_t g = 0; g < group_count_; ++g) {
    if (!groups_[g].is_changed) continue;
    for (const std::uint32_t p : groups_[g].particles) is_changed_[p] = isFree(p);
  }
}

/// Returns the place of a particle in a group. A pinned particle has places in all groups of its
/// springs, and may have several in one.
std::uint32_t Encounters::placeIn(Group& group, std::uint32_t particle) {
  const std::uint32_t place = place_of_[particle];
  if (place < group.particles.size() && group.particles[place] == particle) return place;
  place_of_[particle] = static_cast<std::uint32_t>(group.particles.size());
  group.particles.push_back(particle);
  group.inverse_masses.push_back(system_.inverseMasses()[particle]);
  group.frequencies.push_back(frequencies_[particle]);
  return place_of_[particle];
}

void Encounters::Group::clear() {
  SpringGroup::clear();
  particles.clear();
  is_changed = false;
}

void Encounters::Group::take(const Motion& motion) {
  positions.resize(particles.size());
  angular_velocities.resize(particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i) {
    positions[i] = motion.position(particles[i]);
    angular_velocities[i] = motion.angularVelocity(particles[i]);
  }
}

void Encounters::Group::driftFreely(double duration) {
  if (duration == 0) return;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    positions[i] = rotated(positions[i], duration * angular_velocities[i]);
  }
}

void Encounters::Group::give(Motion& motion) const {
  for (std::size_t i = 0; i < particles.size(); ++i) {
    if (inverse_masses[i] > 0) motion.place(particles[i], positions[i], angular_velocities[i]);
  }
}

/// Groups have no free particle in common.
template <class Work>
void Encounters::forEachGroup(const Work& work) {
  forOnThreads(group_count_, system_.threads(),
               [&](std::ptrdiff_t g) { work(groups_[g], passages_[g]); });
}

void Encounters::enter(double duration, const Motion::Copy& drifted, Motion& motion) {
  if (duration == 0) return;
  const PassageRule rule = {*scheme_, time_step_};
  forEachGroup([&](Group& group, Passages& passages) {
    if (!group.is_changed && !is_all_changed_) return;
    for (const std::uint32_t p : group.particles) {
      if (isFree(p)) motion.putBack(p, drifted);
    }
    group.take(motion);
    group.driftFreely(-duration);
    passages.step(group, rule, duration, 1);
    group.give(motion);
  });
}

void Encounters::drift(double duration, double under_springs, Motion& motion) {
  if (duration == 0) return;
  for (std::size_t g = 0; g < group_count_; ++g) groups_[g].take(motion);
  motion.drift(duration);
  const PassageRule rule = {*scheme_, time_step_};
  forEachGroup([&](Group& group, Passages& passages) {
    passages.step(group, rule, under_springs, 1);
    group.driftFreely(duration - under_springs);
    group.give(motion);
  });
}

}  // namespace spherical_springs::core
