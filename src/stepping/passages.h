// Steps of a few particles past places where conditions of their springs have no derivative.
#pragma once

#include <cstdint>
#include <vector>

#include "base/disjoint_sets.h"
#include "spherical_springs/state.h"
#include "stepping/passage_rule.h"
#include "stepping/spring_group.h"
#include "stepping/yielding_springs.h"

namespace spherical_springs::core {

/// Steps a group of particles under its springs alone. Where a spring is too near a place without
/// derivative for the length of the step, it leaves the step's kicks, and its particles do smaller
/// steps of the same kind in place of the step's drifts: a composition that is reversible and
/// keeps angular momentum, and whose length adapts to each passage. doc/mathematics.md says more.
class Passages {
 public:
  /// Steps a group over `duration` [s], which is 1 deep for a group stepped in place of a drift of
  /// the scene.
  void step(SpringGroup& group, const PassageRule& rule, double duration, int depth);

  /// The passage with the shortest step since it was last cleared.
  Passage shortest;

 private:
  /// Some particles and springs of the group, as indices.
  struct Part {
    const std::uint32_t *particles, *particles_end, *springs, *springs_end;

    std::size_t particleCount() const { return particles_end - particles; }
    std::size_t springCount() const { return springs_end - springs; }
  };
  struct Step {
    const PassageRule& rule;
    Part part;
    double duration;  // [s]
    int depth;
  };
  /// Particles that are stepped in place of a drift, with the springs that asked for it.
  struct Subgroup {
    std::uint32_t particle_begin, particle_end, spring_begin, spring_end;  // in those of the level
    bool is_changed;  // since the first drift was last done
  };
  /// Memory of the steps at one depth. Lists of springs have an entry for each spring of the part,
  /// and flags of particles one for each particle of the group.
  struct Level {
    std::vector<Vector3> positions, angular_velocities;  // of the part's particles at first
    std::vector<Vector3> entered;                        // their velocities before the first kick
    std::vector<Demand> demands;
    std::vector<std::uint32_t> fresh;    // springs that ask, or follow, since groups were formed
    std::vector<std::uint8_t> is_stiff;  // here
    std::vector<StiffSpring> stiff;      // of a kick
    DisjointSets sets;                   // of particles that are divided
    std::vector<std::uint8_t> leads, is_divided, is_changed;
    std::vector<std::uint32_t> subgroup_of;         // by the particle that stands for its set
    std::vector<std::uint32_t> particles, springs;  // of the subgroups, one after another
    std::vector<Subgroup> subgroups;
    std::vector<Vector3> torques;

    void begin(const SpringGroup& group, const Part& part);
    void putBackVelocities(SpringGroup& group, const Part& part) const;
    void putBackChanged(SpringGroup& group, const Part& part) const;
  };
  enum class Range : std::uint8_t { all, changed };

  void step(SpringGroup& group, const Step& step);
  void passFirstKick(SpringGroup& group, const Step& step);
  bool passOtherKicks(SpringGroup& group, const Step& step);
  void drift(SpringGroup& group, const Step& step, std::size_t stage, Range range);
  bool ask(const SpringGroup& group, const Step& step, Range range);
  Demand askOne(const SpringGroup& group, const Step& step, std::uint32_t s);
  void kick(SpringGroup& group, const Step& step, double duration);

  static void divide(const SpringGroup& group, const Part& part, Level& level);
  static void addFollowers(const SpringGroup& group, const Part& part, Level& level);
  static void joinParticles(const SpringGroup& group, const Part& part, Level& level);
  static void listSubgroups(const SpringGroup& group, const Part& part, Level& level);

  std::vector<Level> levels_;
  int kicks_left_ = 0;  // of springs, before these have to bear with the steps that they are in
  std::vector<std::uint32_t> all_particles_, all_springs_;
};

}  // namespace spherical_springs::core
