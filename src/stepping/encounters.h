// The springs of a scene that pass a place without derivative in the present step, and their
// particles.
#pragma once

#include <cstdint>
#include <vector>

#include "base/disjoint_sets.h"
#include "spherical_springs/system.h"
#include "stepping/motion.h"
#include "stepping/passages.h"

namespace spherical_springs::core {

/// Springs that ask for shorter steps leave the kicks of the scene's step; their particles are
/// stepped group by group in place of its drifts. `PassageRule` says when they do.
class Encounters {
 public:
  /// `patch_count`: of the layout. `time_step`: of the scene [s].
  Encounters(const System& system, std::size_t patch_count, double time_step);

  /// Begins a step of `scheme`, in which no spring has asked yet.
  void begin(const SplittingScheme& scheme);

  /// Finds out, after a kick, for which springs the step is too long: by the places of their ends,
  /// and by the velocities of these before the kick, `entered`, and after it. Those that ask for a
  /// shorter step, and those that have to follow, are then `leftOut()`. Springs whose ends are
  /// where they were at the last question, with the same velocities, are passed over.
  /// @return whether any spring asked that had not asked before.
  bool ask(const Motion& motion, const Motion::Velocities& entered);

  /// Lets the next question go to all springs.
  void expectChange() { is_all_changed_ = true; }

  const SpringSubset& leftOut() const { return left_out_; }

  /// Whether any spring has asked in this step.
  bool anyAsked() const { return group_count_ > 0; }

  /// The passage with the shortest step in this step of the scene; its time is not filled in.
  Passage shortest() const;

  /// Does the drift to the first kick, of `duration` [s], again from `drifted`, where it was done
  /// for all particles: under their springs for those of groups that have changed.
  void enter(double duration, const Motion::Copy& drifted, Motion& motion);

  /// Drifts all particles for `duration` [s], those of groups under their springs for
  /// `under_springs` of that.
  void drift(double duration, double under_springs, Motion& motion);

 private:
  static constexpr std::uint32_t kNoGroup = ~0u;

  struct Asking {
    std::uint32_t index;  // of the spring
    Demand demand;
  };
  template <class Spring>
  struct AskingSprings : std::vector<Asking> {};
  /// Answers of the springs of a patch.
  struct Answers {
    PerKind<AskingSprings> asking;
    Passage shortest;

    void clear();
  };
  template <class Spring>
  struct Demands : std::vector<Demand> {};

  struct Group : SpringGroup {
    std::vector<std::uint32_t> particles;  // of the scene
    bool is_changed;                       // since it was last entered

    void clear();
    void take(const Motion& motion);
    void driftFreely(double duration);
    void give(Motion& motion) const;
  };

  bool isFree(std::uint32_t particle) const { return system_.inverseMasses()[particle] > 0; }
  void askPatch(std::size_t patch, const Motion& motion, const Motion::Velocities& entered);
  template <class Spring>
  void askOne(std::uint32_t index, const Motion& motion, const Motion::Velocities& entered,
              Answers& answers) const;
  template <class Spring>
  bool isConcerned(const Spring& spring, const Motion& motion) const;
  void gather();
  void addFollowers();
  template <class Spring>
  void leaveOut(std::uint32_t index, Demand demand);
  template <class Spring>
  void sortLeftOut(const std::vector<std::uint32_t>& places);
  void makeGroups(const std::vector<std::uint32_t>& places);
  void joinParticles();
  template <class Spring>
  Group& groupOf(const Spring& spring);
  std::uint32_t placeIn(Group& group, std::uint32_t particle);
  template <class Visitor>
  void forEachIn(const SpringSubset& springs, const Visitor& visit) const;
  template <class Work>
  void forEachGroup(const Work& work);

  const System& system_;
  const double time_step_;
  const std::vector<double> frequencies_;  // of each particle
  const SplittingScheme* scheme_ = nullptr;
  bool is_all_changed_ = true;
  std::vector<Answers> answers_;                    // of each patch
  PerKind<Demands> demands_;                        // of all springs
  SpringSubset left_out_, fresh_;                   // fresh: since groups were made
  Motion::Velocities asked_;                        // after the last kick that was asked about
  std::vector<std::uint8_t> leads_, is_changed_;    // of each particle
  DisjointSets sets_;                               // of particles that springs left out join
  std::vector<std::uint32_t> group_of_, place_of_;  // of each particle, where it has one
  std::vector<Group> groups_;
  std::vector<Passages> passages_;  // of each group
  std::size_t group_count_ = 0;
  Passage shortest_;  // among steps of the scene itself
};

template <class Visitor>
void Encounters::forEachIn(const SpringSubset& springs, const Visitor& visit) const {
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    for (const std::uint32_t index : springs.get<Spring>()) {
      visit(system_.springs<Spring>()[index], system_.springId<Spring>(index));
    }
  });
}

}  // namespace spherical_springs::core
