#include "stepping/passages.h"

#include <algorithm>
#include <numeric>
#include <variant>

namespace spherical_springs::core {

void Passages::step(SpringGroup& group, const PassageRule& rule, double duration, int depth) {
  constexpr int kMostKicks = 200000;  // many times what any passage takes that comes to an end
  kicks_left_ = kMostKicks;
  levels_.resize(PassageRule::kDeepest + 1);
  all_particles_.resize(group.positions.size());
  all_springs_.resize(group.springs.size());
  std::iota(all_particles_.begin(), all_particles_.end(), 0u);
  std::iota(all_springs_.begin(), all_springs_.end(), 0u);
  const std::uint32_t *particles = all_particles_.data(), *springs = all_springs_.data();
  const Part all = {particles, particles + all_particles_.size(), springs,
                    springs + all_springs_.size()};
  step(group, {rule, all, duration, depth});
}

// Springs that ask are left out of all kicks of the step, so that each of them that is new lets the
// step begin again. At the first kick, where nearly all of them ask, only particles that the new
// ones concern do so.
void Passages::step(SpringGroup& group, const Step& step) {
  Level& level = levels_[step.depth];
  level.begin(group, step.part);
  for (;;) {
    passFirstKick(group, step);
    if (passOtherKicks(group, step)) return;
    divide(group, step.part, level);
    for (auto p = step.part.particles; p != step.part.particles_end; ++p) {
      level.is_changed[*p] = true;
    }
    level.putBackChanged(group, step.part);
  }
}

void Passages::passFirstKick(SpringGroup& group, const Step& step) {
  Level& level = levels_[step.depth];
  const auto beginAgain = [&] {
    divide(group, step.part, level);
    level.putBackChanged(group, step.part);
    drift(group, step, 0, Range::changed);
  };
  drift(group, step, 0, Range::all);
  for (;;) {
    while (ask(group, step, Range::changed)) beginAgain();
    level.entered.clear();
    for (auto p = step.part.particles; p != step.part.particles_end; ++p) {
      level.entered.push_back(group.angular_velocities[*p]);
    }
    kick(group, step, step.rule.scheme.kick[0] * step.duration);
    if (!ask(group, step, Range::all)) return;
    level.putBackVelocities(group, step.part);
    beginAgain();
  }
}

/// @return false where a spring asks for shorter steps that has not asked before.
bool Passages::passOtherKicks(SpringGroup& group, const Step& step) {
  const SplittingScheme& scheme = step.rule.scheme;
  for (std::size_t stage = 1; stage < scheme.kick.size(); ++stage) {
    drift(group, step, stage, Range::all);
    if (ask(group, step, Range::all)) return false;
    kick(group, step, scheme.kick[stage] * step.duration);
    if (ask(group, step, Range::all)) return false;
  }
  drift(group, step, scheme.kick.size(), Range::all);
  return true;
}

void Passages::drift(SpringGroup& group, const Step& step, std::size_t stage, Range range) {
  const Part& part = step.part;
  const Level& level = levels_[step.depth];
  const double duration = step.rule.scheme.drift[stage] * step.duration;
  if (duration == 0) return;
  if (range == Range::all) {
    for (auto p = part.particles; p != part.particles_end; ++p) {
      if (!level.is_divided[*p]) group.drift(*p, duration);
    }
  }
  const std::uint32_t *particles = level.particles.data(), *springs = level.springs.data();
  for (const Subgroup& one : level.subgroups) {
    if (range == Range::changed && !one.is_changed) continue;
    const Part subgroup = {particles + one.particle_begin, particles + one.particle_end,
                           springs + one.spring_begin, springs + one.spring_end};
    this->step(group, {step.rule, subgroup, duration, step.depth + 1});
  }
}

/// Asks springs, or those at changed particles, where they have not asked yet.
bool Passages::ask(const SpringGroup& group, const Step& step, Range range) {
  Level& level = levels_[step.depth];
  const auto isConcerned = [&](std::uint32_t spring) {
    bool is_concerned = range == Range::all;
    if (!is_concerned) {
      group.forEachFreeEnd(spring, [&](std::uint32_t p) { is_concerned |= level.is_changed[p]; });
    }
    return is_concerned;
  };
  for (std::uint32_t s = 0; s < step.part.springCount(); ++s) {
    if (level.demands[s] != Demand::none || !isConcerned(step.part.springs[s])) continue;
    level.demands[s] = askOne(group, step, s);
    if (level.demands[s] != Demand::none) level.fresh.push_back(s);
  }
  return !level.fresh.empty();
}

Demand Passages::askOne(const SpringGroup& group, const Step& step, std::uint32_t s) {
  Level& level = levels_[step.depth];
  const std::uint32_t index = step.part.springs[s];
  const auto ask = [&](const auto& spring) {
    level.is_stiff[s] = false;
    const auto ends = group.endsOf(spring);
    if (!isNear(spring, ends.points)) return Demand::none;
    constexpr double kStiff = 1;  // turn of the gradient in a step [rad]
    const Approach near = approach(spring, ends);
    level.is_stiff[s] = std::abs(step.duration) * near.falling > kStiff;
    if (kicks_left_ <= 0) return Demand::none;
    const Demand demand = step.rule.demandOf(near, group.frequencyOf(spring),
                                             {step.duration, step.depth, step.part.springCount()});
    if (demand != Demand::none) {
      step.rule.note<std::decay_t<decltype(spring)>>(near, step.duration, group.ids[index],
                                                     shortest);
    }
    return demand;
  };
  return std::visit(ask, group.springs[index]);
}

/// Kicks by the springs that do not step by themselves.
void Passages::kick(SpringGroup& group, const Step& step, double duration) {
  const Part& part = step.part;
  Level& level = levels_[step.depth];
  kicks_left_ -= static_cast<int>(part.springCount());
  level.stiff.clear();
  for (auto p = part.particles; p != part.particles_end; ++p) level.torques[*p].setZero();
  for (std::uint32_t s = 0; s < part.springCount(); ++s) {
    if (level.demands[s] != Demand::none) continue;
    std::visit(
        [&](const auto& spring) {
          const auto c = condition(spring, group.endsOf(spring).points);
          for (std::size_t i = 0; i < spring.particles.size(); ++i) {
            level.torques[spring.particles[i]] -= spring.stiffness * c.value * c.gradient[i];
          }
          if (!level.is_stiff[s]) return;
          StiffSpring stiff = {spring.stiffness, {}, {}, spring.particles.size()};
          std::copy(spring.particles.begin(), spring.particles.end(), stiff.particles.begin());
          std::copy(c.gradient.begin(), c.gradient.end(), stiff.gradient.begin());
          level.stiff.push_back(stiff);
        },
        group.springs[part.springs[s]]);
  }
  if (!level.stiff.empty()) {
    yieldTo(level.stiff, group.inverse_masses, step.duration, level.torques);
  }
  for (auto p = part.particles; p != part.particles_end; ++p) {
    group.angular_velocities[*p] += duration * group.inverse_masses[*p] * level.torques[*p];
  }
}

}  // namespace spherical_springs::core
