// When springs near places without derivative ask for shorter steps.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "spherical_springs/state.h"
#include "spherical_springs/system.h"
#include "stepping/approach.h"
#include "stepping/splitting.h"

namespace spherical_springs::core {

/// Whether a spring asks for a shorter step, and whether the springs that share particles with it
/// are to follow it.
enum class Demand : std::uint8_t { none, follows, own, with_neighbours };

/// A step of some particles, in which springs are asked.
struct DividedStep {
  double duration;         ///< [s]
  int depth;               ///< 0 for a step of the scene
  std::size_t group_size;  ///< how many springs are stepped together; 1 in a step of the scene
};

/// The rule by which steps are divided.
struct PassageRule {
  static constexpr int kDeepest = 40;  ///< beyond which rounding would make the steps

  const SplittingScheme& scheme;  ///< of at least second order
  double time_step;               ///< of the scene [s]

  /// Returns what a spring demands.
  /// `frequency`: the highest of its particles [rad/s]. `step`: that it is in.
  Demand demandOf(const Approach& approach, double frequency, const DividedStep& step) const;

  /// Takes a spring that asks in a step of `duration` [s] into account: its shortest step so far.
  template <class Spring>
  void note(const Approach& approach, double duration, std::uint32_t id, Passage& shortest) const {
    const double substep = longestShare() * std::abs(duration);
    if (shortest.substep > 0 && shortest.substep <= substep) return;
    shortest = {substep, approach.distance, approach.place, Spring::kName, id, shortest.time};
  }

 private:
  static double turningOf(const Approach& approach, int depth);
  double longestShare() const;  ///< of a drift in a step
};

/// Returns the frequency by which passages of each particle are resolved: above those of all its
/// springs about their places at rest [rad/s].
std::vector<double> passageFrequencies(const System& system);

}  // namespace spherical_springs::core
