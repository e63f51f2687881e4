// The scene as a person describes it. Everything is checked here, at the door, and nowhere after.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "spherical_springs/id_table.h"
#include "spherical_springs/range.h"
#include "spherical_springs/sphere.h"
#include "spherical_springs/springs/kinds.h"

namespace spherical_springs::core {

/// A particle as a caller describes it. The scene makes the position a unit vector and the angular
/// velocity normal to it.
struct Particle {
  Vector3 position = Vector3::Zero();          ///< any finite non-zero vector before the door
  Vector3 angular_velocity = Vector3::Zero();  ///< [rad/s]
  double mass = 0;                             ///< [kg]; 0 means 1 before the door
  double damping = 0;                          ///< [N m s/rad]
  bool pinned = false;                         ///< never moves by itself

  /// Calls `visit(name, value, range)` for each number that has a range of allowed values.
  template <class P, class Visitor>
  static void visitFields(P& particle, Visitor&& visit) {
    visit("mass", particle.mass,
          Range{kSmallest, kLargest, "0 (meaning 1), or 1e-30 to 1e30 [kg]"});
    visit("damping", particle.damping, Range{0, kLargest, "0 to 1e30 [N m s/rad]"});
  }
};

/// How many items a scene may hold.
struct SceneLimits {
  /// The most particles that indices of 32 bits can tell apart; a limit above counts as this.
  static constexpr std::size_t kMostParticles = 400'000'000;
  /// The most springs that indices of 32 bits can tell apart; a limit above counts as this.
  static constexpr std::size_t kMostSprings = 3'600'000'000 / (kMostEnds * (kMostEnds - 1));

  std::size_t particles = 20'000'000;  ///< the most
  std::size_t springs = 100'000'000;   ///< of all kinds together

  /// These limits where indices hold so many, and else as many as they hold.
  SceneLimits heldByIndices() const {
    return {std::min(particles, kMostParticles), std::min(springs, kMostSprings)};
  }
};

/// Particles and springs under their ids. Each changing function checks the whole request first and
/// throws std::invalid_argument, which names item, field, value and what is allowed, before
/// anything is changed; so it is when memory runs out. Particles' places here are those at which
/// they were last added or set.
/// \snippet test_headers.cpp scene
/// \snippet test_headers.cpp scene_refuses
class Scene {
 public:
  /// An empty scene.
  explicit Scene(SceneLimits limits = {}) : limits_(limits.heldByIndices()) {}

  /// A whole scene under ids of the caller's choice, each list rising. Springs that ask for it take
  /// their rest values from the particles' positions.
  /// @throw std::invalid_argument as the changing functions do.
  Scene(SceneLimits limits, const std::vector<std::uint32_t>& particle_ids,
        std::vector<Particle> particles, const SpringIds& spring_ids, SpringLists springs);

  const IdTable<Particle>& particles() const { return particles_; }  ///< under their ids
  /// Springs of a kind, whose `particles` are ids.
  template <class Spring>
  const IdTable<Spring>& springs() const {
    return springs_.get<Spring>();
  }
  std::size_t springCount() const;  ///< of all kinds together

  /// Adds particles.
  /// @return their ids, in the order of `particles`.
  std::vector<std::uint32_t> addParticles(std::vector<Particle> particles);

  /// The effect of a call of `setParticles`.
  struct Setting {
    std::vector<std::size_t> indices;  ///< of the particles that were set
    bool only_moved = true;            ///< whether masses, damping and pins are as they were
  };
  /// Puts new values under old ids, one particle for each id.
  Setting setParticles(const std::vector<std::uint32_t>& ids, std::vector<Particle> particles);

  /// The effect of a call of `removeParticles`.
  struct Removal {
    std::vector<bool> particles;  ///< by index before the removal
    std::size_t springs = 0;      ///< how many of all kinds
  };
  /// Removes particles and every spring that joins one of them.
  Removal removeParticles(const std::vector<std::uint32_t>& ids);

  /// `positions`: of the particles at present, one column each in the order of ids, from which
  /// springs that ask for it take their rest values.
  /// @return the ids of the springs, in the order of the lists.
  SpringIds addSprings(SpringLists springs, const Points& positions);
  /// Puts new values under old ids, one spring for each id; `positions` as in `addSprings`.
  /// @return whether each of them joins the particles that it joined before, in the same order.
  bool setSprings(const SpringIds& ids, SpringLists springs, const Points& positions);
  /// Removes springs; no id may be given twice.
  void removeSprings(const SpringIds& ids);

  /// Puts the particles elsewhere: one column each, unit positions and the angular velocities
  /// normal to them, as stepping leaves them.
  void place(const Points& positions, const Points& angular_velocities);

  /// Takes every particle and spring away. Their ids are not given again.
  void clear();

  /// Ids below those that `earlier` has given will not be given here.
  /// @throw std::invalid_argument where ids here are above kLargestChosenId and above all that
  /// `earlier` has given.
  void reserveIdsOf(const Scene& earlier);

 private:
  /// Springs of one kind, marked by their indices.
  template <class Spring>
  struct Marks {
    std::vector<bool> values;
  };

  void remove(const PerKind<Marks>& doomed);
  void checkSprings(SpringLists& springs, const Points& positions) const;

  SceneLimits limits_;
  IdTable<Particle> particles_;
  PerKind<IdTable> springs_;
};

}  // namespace spherical_springs::core
