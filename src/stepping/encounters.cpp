#include "stepping/encounters.h"

#include <algorithm>

#include "base/parallel.h"

namespace spherical_springs::core {
namespace {

/// Whether a spring is never left out: its damping acts in the kicks of the scene, together with
/// its forces.
template <class Spring>
bool staysInKicks(const Spring& spring) {
  return spring.damping > 0;
}

void takeIfShorter(const Passage& passage, Passage& shortest) {
  if (passage.substep == 0) return;
  if (shortest.substep == 0 || passage.substep < shortest.substep) shortest = passage;
}

}  // namespace

Encounters::Encounters(const System& system, std::size_t patch_count, double time_step)
    : system_(system),
      time_step_(time_step),
      frequencies_(passageFrequencies(system)),
      answers_(patch_count),
      leads_(system.particleCount(), false),
      is_changed_(leads_),
      sets_(system.particleCount()),
      group_of_(system.particleCount(), kNoGroup),
      place_of_(system.particleCount()) {
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    demands_.get<Spring>().resize(system.springs<Spring>().size());
  });
}

void Encounters::begin(const SplittingScheme& scheme) {
  scheme_ = scheme.order > 1 ? &scheme : &splittingScheme(IntegrationMethod::verlet);
  is_all_changed_ = true;
  group_count_ = 0;
  shortest_ = {};
  for (Passages& passages : passages_) passages.shortest = {};
  forEachIn(left_out_, [&](const auto& spring, std::uint32_t) {
    for (const std::uint32_t p : spring.particles) {
      leads_[p] = is_changed_[p] = false;
      group_of_[p] = kNoGroup;
    }
  });
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    std::vector<Demand>& demands = demands_.get<Spring>();
    for (const std::uint32_t index : left_out_.get<Spring>()) demands[index] = Demand::none;
    left_out_.get<Spring>().clear();
    fresh_.get<Spring>().clear();
  });
}

Passage Encounters::shortest() const {
  Passage shortest = shortest_;
  for (const Passages& passages : passages_) takeIfShorter(passages.shortest, shortest);
  return shortest;
}

bool Encounters::ask(const Motion& motion, const Motion::Velocities& entered) {
  forOnThreads(static_cast<std::ptrdiff_t>(answers_.size()), system_.threads(),
               [&](std::ptrdiff_t patch) { askPatch(patch, motion, entered); });
  gather();
  is_all_changed_ = false;
  bool any_fresh = false;
  forEachKind(
      [&](auto kind) { any_fresh |= !fresh_.get<typename decltype(kind)::type>().empty(); });
  if (!any_fresh) return false;
  motion.copyTo(asked_);
  addFollowers();
  makeGroups(motion.places());
  return true;
}

void Encounters::Answers::clear() {
  forEachKind([&](auto kind) { asking.get<typename decltype(kind)::type>().clear(); });
  shortest = {};
}

/// Asks the springs of a patch that the kick has found to be near.
void Encounters::askPatch(std::size_t patch, const Motion& motion,
                          const Motion::Velocities& entered) {
  Answers& answers = answers_[patch];
  answers.clear();
  motion.forEachNearSpring(patch, [&](auto kind, std::uint32_t index) {
    askOne<typename decltype(kind)::type>(index, motion, entered, answers);
  });
}

template <class Spring>
void Encounters::askOne(std::uint32_t index, const Motion& motion,
                        const Motion::Velocities& entered, Answers& answers) const {
  if (demands_.get<Spring>()[index] != Demand::none) return;
  const Spring spring = turned(system_.springs<Spring>()[index], motion.places());
  if (staysInKicks(spring) || !isConcerned(spring, motion)) return;
  MovingEnds<Spring::kParticles> ends;
  for (std::size_t i = 0; i < Spring::kParticles; ++i) {
    ends.points[i] = motion.position(spring.particles[i]);
  }
  if (!isNear(spring, ends.points)) return;
  ends.largest_inverse_mass = 0;
  double frequency = 0;
  for (const std::uint32_t p : spring.particles) {
    ends.largest_inverse_mass = std::max(ends.largest_inverse_mass, system_.inverseMasses()[p]);
    frequency = std::max(frequency, frequencies_[p]);
  }
  ends.times = 2;
  for (std::size_t i = 0; i < Spring::kParticles; ++i) {
    const std::uint32_t p = spring.particles[i];
    ends.angular_velocities[0][i] = motion.angularVelocity(p, entered);
    ends.angular_velocities[1][i] = motion.angularVelocity(p);
  }
  const PassageRule rule = {*scheme_, time_step_};
  const Approach near = approach(spring, ends);
  const Demand demand = rule.demandOf(near, frequency, {time_step_, 0, 1});
  if (demand == Demand::none) return;
  rule.note<Spring>(near, time_step_, system_.springId<Spring>(index), answers.shortest);
  answers.asking.get<Spring>().push_back({index, demand});
}

template <class Spring>
bool Encounters::isConcerned(const Spring& spring, const Motion& motion) const {
  return is_all_changed_ ||
         std::any_of(spring.particles.begin(), spring.particles.end(), [&](std::uint32_t p) {
           return is_changed_[p] || motion.angularVelocity(p) != motion.angularVelocity(p, asked_);
         });
}

/// Takes the answers of all patches in their order; springs between patches may be in several.
void Encounters::gather() {
  for (const Answers& answers : answers_) {
    takeIfShorter(answers.shortest, shortest_);
    forEachKind([&](auto kind) {
      using Spring = typename decltype(kind)::type;
      for (const auto& [index, demand] : answers.asking.get<Spring>()) {
        if (demands_.get<Spring>()[index] == Demand::none) leaveOut<Spring>(index, demand);
      }
    });
  }
}

template <class Spring>
void Encounters::leaveOut(std::uint32_t index, Demand demand) {
  left_out_.get<Spring>().push_back(index);
  fresh_.get<Spring>().push_back(index);
  demands_.get<Spring>()[index] = demand;
}

/// Lets springs follow those that share particles with them and want it.
void Encounters::addFollowers() {
  bool any_leads = false;
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    for (const std::uint32_t index : fresh_.get<Spring>()) {
      if (demands_.get<Spring>()[index] != Demand::with_neighbours) continue;
      any_leads = true;
      for (const std::uint32_t p : system_.springs<Spring>()[index].particles) {
        leads_[p] = isFree(p);
      }
    }
  });
  if (!any_leads) return;
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    const auto& springs = system_.springs<Spring>();
    for (std::uint32_t s = 0; s < springs.size(); ++s) {
      const auto& particles = springs[s].particles;
      if (demands_.get<Spring>()[s] == Demand::none && !staysInKicks(springs[s]) &&
          std::any_of(particles.begin(), particles.end(), [&](auto p) { return leads_[p]; })) {
        leaveOut<Spring>(s, Demand::follows);
      }
    }
  });
}

}  // namespace spherical_springs::core
