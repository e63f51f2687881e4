#include "stepping/passage_rule.h"

#include <algorithm>

namespace spherical_springs::core {

double PassageRule::longestShare() const {
  const auto [least, most] = std::minmax_element(scheme.drift.begin(), scheme.drift.end());
  return std::max(*most, -*least);
}

namespace {

/// Limits that a spring bears in a step.
struct Tolerance {
  double turn;      ///< of its gradient, by h Omega
  double urgent;    ///< times that: more lets its neighbours follow
  double approach;  ///< to a jump, by the distance from it
  int jump_depth;   ///< down to which jumps are resolved
};

// Found by trials with random scenes, as those that give the energy a walk of 1e-2 (verlet) and
// 1e-4 (fourth_order) in 1e6 steps at the least cost; benchmark/README.md has them.
constexpr Tolerance kOfSecondOrder = {1.8, 8, 1, 8};
constexpr Tolerance kOfHigherOrder = {4, 4, 0.3, 12};

}  // namespace

// A passage is resolved about as well as the swings of the scene are: by steps in which the
// gradient turns no further than h Omega, where Omega is the frequency of those swings and h the
// scene's step. So the order of the scheme holds, and the cost does not depend on the step. An
// error at a jump is small beside the energy of many springs, so that each doubling of a group
// takes a level off.
Demand PassageRule::demandOf(const Approach& approach, double frequency,
                             const DividedStep& step) const {
  const auto& [duration, depth, group_size] = step;
  constexpr double kUnstable = 4;  // a step by h Omega, which does not bear the swings either
  if (depth >= kDeepest || time_step * frequency > kUnstable) return Demand::none;
  constexpr double kLeastTurn = 0.02, kMostTurn = 0.3;  // [rad]
  const Tolerance& tolerance = scheme.order > 2 ? kOfHigherOrder : kOfSecondOrder;
  const double most_turn =
      std::clamp(tolerance.turn * time_step * frequency, kLeastTurn, kMostTurn);
  const double turn = std::abs(duration) * turningOf(approach, depth);
  if (turn > tolerance.urgent * most_turn) return Demand::with_neighbours;
  if (turn > most_turn) return Demand::own;
  const int jump_depth = tolerance.jump_depth - std::ilogb(static_cast<double>(group_size));
  const bool is_coarse = depth < jump_depth || turn > std::ldexp(most_turn, -jump_depth);
  const bool is_close = std::abs(duration) * approach.closing > tolerance.approach;
  return is_coarse && is_close ? Demand::own : Demand::none;
}

// Where a spring has little energy, and its ends are slow, as damping may leave them there, they
// need not be followed all the way: its kicks yield.
double PassageRule::turningOf(const Approach& approach, int depth) {
  constexpr int kDeep = 4;
  constexpr double kLittle = 1e-4;
  const double turning =
      std::sqrt(approach.turning * approach.turning + approach.pull * approach.pull);
  return depth >= kDeep && turning < kLittle * approach.falling ? 0 : turning;
}

std::vector<double> passageFrequencies(const System& system) {
  std::vector<double> stiffness(system.particleCount(), 0);
  forEachKind([&](auto kind) {
    for (const auto& spring : system.springs<typename decltype(kind)::type>()) {
      for (const std::uint32_t i : spring.particles) stiffness[i] += spring.stiffness;
    }
  });
  std::vector<double> frequencies(stiffness.size());
  for (std::size_t i = 0; i < stiffness.size(); ++i) {
    frequencies[i] = 2 * std::sqrt(stiffness[i] * system.inverseMasses()[i]);
  }
  return frequencies;
}

}  // namespace spherical_springs::core
