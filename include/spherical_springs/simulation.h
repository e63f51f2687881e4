// A scene that lives: what a person described, and where it has come to since.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "spherical_springs/integrator.h"
#include "spherical_springs/measures.h"
#include "spherical_springs/scene.h"
#include "spherical_springs/scene_file.h"
#include "spherical_springs/state.h"
#include "spherical_springs/system.h"

namespace spherical_springs::core {

/// How a simulation is to step.
/// \snippet test_headers.cpp accuracy
struct StepWish {
  static constexpr double kShortest = 1e-12;  ///< the shortest time step that is chosen [s]
  static constexpr double kLongest = 1e6;     ///< the longest time step that is chosen [s]

  IntegrationMethod method = IntegrationMethod::verlet;  ///< unless it is chosen
  double time_step = 0.001;  ///< [s]; above an accuracy of 0, only where nothing moves
  double accuracy = 0;       ///< largest error per simulated second [rad/s]; 0: any, by `time_step`
  bool chooses_method = false;  ///< `verlet` or `fourth_order`, whichever takes less work

  /// @throw std::invalid_argument naming what is wrong and what is allowed: a time step above 0, an
  /// accuracy of 0 or above, and of more than 0 where the method is to be chosen.
  void requireValid() const;

  /// Whether it asks for the same steps as `other`.
  bool asksTheSameAs(const StepWish& other) const;
};

/// How a simulation steps.
struct StepChoice {
  IntegrationMethod method = IntegrationMethod::verlet;  ///< of the steps
  double time_step = 0.001;                              ///< [s]
  double error_rate = 0;   ///< estimated for it, where an accuracy was asked for [rad/s]
  bool is_reached = true;  ///< whether that is within the accuracy
  std::uint64_t steps_to_review = ~std::uint64_t(0);  ///< after which it is looked at again
};

/// For one thread at a time. Changing functions throw what Scene's throw, or std::bad_alloc, and
/// then change nothing; each that changes something begins the account of energy anew.
/// \snippet test_headers.cpp simulation
class Simulation {
 public:
  /// Choices that last as long as the simulation, but for the wish, which `stepBy` changes.
  struct Settings : StepWish {
    System::Options system;  ///< damping of springs, and threads
    SceneLimits limits;      ///< how much the scene may hold
  };

  /// An empty scene at time 0.
  /// @throw std::invalid_argument as StepWish::requireValid does.
  explicit Simulation(const Settings& settings);

  /// Adds particles as Scene::addParticles does; the others keep the places that they have come to.
  std::vector<std::uint32_t> addParticles(std::vector<Particle> particles);
  /// Sets particles as Scene::setParticles does. What is compiled for stepping is kept if masses,
  /// damping and pins are as they were, and else the order of particles and springs in it.
  void setParticles(const std::vector<std::uint32_t>& ids, std::vector<Particle> particles);
  /// Removes particles as Scene::removeParticles does.
  /// @return how many springs went with them.
  std::size_t removeParticles(const std::vector<std::uint32_t>& ids);
  /// Adds springs as Scene::addSprings does, with rest values taken from where the particles are
  /// now.
  SpringIds addSprings(SpringLists springs);
  /// Sets springs as Scene::setSprings does, with rest values taken from where the particles are
  /// now. The order of particles and springs that is compiled for stepping is kept if they join the
  /// same particles.
  void setSprings(const SpringIds& ids, SpringLists springs);
  /// Removes springs as Scene::removeSprings does.
  void removeSprings(const SpringIds& ids);

  void clear();  ///< Removes all particles and springs, and sets the time to 0.
  void reset();  ///< Puts every particle where it was last added or set, and sets the time to 0.

  /// Replaces the scene and its time.
  /// @throw std::invalid_argument as Scene::reserveIdsOf does.
  void load(SceneFile file);

  /// Says how the steps to come are to be. Scene, state, time and account go on.
  /// @throw std::invalid_argument as StepWish::requireValid does.
  void stepBy(const StepWish& wish);

  /// Returns how the next step is done. It is chosen for an accuracy when first asked for after a
  /// change of scene or wish, and looked at again after a number of steps that it names itself.
  /// Bits of states depend neither on who asks nor on how steps are cut into calls.
  const StepChoice& choice();

  /// The choice as it is, which may be of another scene or wish until `choice` or `step` is called.
  const StepChoice& lastChoice() const { return choice_; }

  /// Steps: all of them, or none where memory runs out.
  void step(std::uint64_t steps = 1);

  /// Puts the particles, at rest, at `positions`, where a relaxation has brought them: one unit
  /// vector a particle, in the order of ids. Changes nothing, not even the account, where they are
  /// there and at rest already.
  void settle(const Points& positions);

  /// A state, and how it was stepped.
  struct Moment {
    State state;        ///< where the particles were
    StepChoice choice;  ///< with the steps that were left to its review
  };
  /// Returns the present moment, for `restore`.
  Moment moment();
  /// Puts back an earlier moment of the same scene and wish.
  void restore(Moment moment);

  /// Returns the settings, with the wish that was told last.
  const Settings& settings() const { return settings_; }
  const Scene& scene() const { return scene_; }  ///< with particles where they were last set
  const State& state() const;                    ///< where the particles are now
  Scene presentScene() const;                    ///< with the particles where they are now

  /// Returns the scene as it is compiled, which is done when it is first asked for after a change.
  std::shared_ptr<const Plan> plan();
  /// Returns the account of energy, which begins at the first call after a change.
  std::shared_ptr<Account> account();

  /// The account without making it: null until something has asked for it.
  std::shared_ptr<Account> begunAccount() const { return account_; }

  /// A number that changes with everything that moves or changes the scene.
  std::uint64_t revision() const { return revision_; }
  /// A number that changes with the particles and springs that there are, what springs join and
  /// what is pinned.
  std::uint64_t topology() const { return topology_; }

  /// Offers an account that was made of the state at `revision`.
  /// @return the account of that state: the one there was, or the one offered, which is taken
  /// unless the state has changed since.
  std::shared_ptr<Account> begin(std::shared_ptr<Account> account, std::uint64_t revision);

 private:
  State& changeState();
  void beginAt(State start);
  StepChoice chosenFor(const StepWish& wish);
  void adopt(const StepChoice& choice);
  void stepAtOnce(std::uint64_t steps);
  void moved();
  void parametersChanged();
  void topologyChanged();

  Settings settings_;
  Scene scene_;
  mutable State state_;
  mutable bool integrator_is_ahead_ = false;  // of the state
  bool integrator_has_state_ = false;
  StepChoice choice_;
  bool choice_holds_ = false;  // for the present scene and wish
  // Made when first needed after a change; the plan and the integrator outlive moves.
  std::shared_ptr<const Plan> plan_;
  std::shared_ptr<const Plan> earlier_plan_;  // of the same topology, with other parameters
  std::unique_ptr<Integrator> integrator_;
  std::shared_ptr<Account> account_;
  std::uint64_t revision_ = 0, topology_ = 0;
};

}  // namespace spherical_springs::core
