// A few particles and springs of a scene, which are stepped by themselves.
#pragma once

#include <algorithm>
#include <cstdint>
#include <variant>
#include <vector>

#include "spherical_springs/springs/kinds.h"
#include "stepping/approach.h"

namespace spherical_springs::core {

namespace detail {

template <class List>
struct VariantOf;
template <class... Springs>
struct VariantOf<KindList<Springs...>> {
  using type = std::variant<Springs...>;
};

}  // namespace detail

/// A spring of any kind.
using AnySpring = detail::VariantOf<Kinds>::type;

/// Particles, and springs whose `particles` are their indices here.
struct SpringGroup {
  std::vector<Vector3> positions;           ///< unit vectors
  std::vector<Vector3> angular_velocities;  ///< [rad/s]
  std::vector<double> inverse_masses;       ///< [1/kg]; 0 for pinned particles
  std::vector<double> frequencies;          ///< as `passageFrequencies` has them [rad/s]
  std::vector<AnySpring> springs;
  std::vector<std::uint32_t> ids;  ///< of the springs

  void clear();
  void drift(std::uint32_t particle, double duration);
  bool isFree(std::uint32_t particle) const { return inverse_masses[particle] > 0; }

  /// Calls `visit(particle)` for the particles of a spring that are not pinned.
  template <class Visitor>
  void forEachFreeEnd(std::uint32_t spring, const Visitor& visit) const {
    std::visit(
        [&](const auto& s) {
          for (const std::uint32_t particle : s.particles) {
            if (isFree(particle)) visit(particle);
          }
        },
        springs[spring]);
  }

  template <class Spring>
  MovingEnds<Spring::kParticles> endsOf(const Spring& spring) const {
    MovingEnds<Spring::kParticles> ends;
    ends.times = 1;
    ends.largest_inverse_mass = 0;
    for (std::size_t i = 0; i < Spring::kParticles; ++i) {
      const std::uint32_t particle = spring.particles[i];
      ends.points[i] = positions[particle];
      ends.angular_velocities[0][i] = angular_velocities[particle];
      ends.largest_inverse_mass = std::max(ends.largest_inverse_mass, inverse_masses[particle]);
    }
    return ends;
  }

  /// Returns the highest frequency of a spring's particles [rad/s].
  template <class Spring>
  double frequencyOf(const Spring& spring) const {
    double highest = 0;
    for (const std::uint32_t p : spring.particles) highest = std::max(highest, frequencies[p]);
    return highest;
  }
};

}  // namespace spherical_springs::core
