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

/// For one thread at a time. Changing functions throw what Scene's throw, or std::bad_alloc, and
/// then change nothing; each that changes something begins the account of energy anew.
/// \snippet test_headers.cpp simulation
class Simulation {
 public:
  /// Choices that last as long as the simulation, but for those that `stepBy` changes.
  struct Settings {
    IntegrationMethod method = IntegrationMethod::verlet;  ///< of `step`
    double time_step = 0.001;                              ///< [s]
    System::Options system;                                ///< damping of springs, and threads
    SceneLimits limits;                                    ///< how much the scene may hold
  };

  /// An empty scene at time 0.
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

  /// Chooses the method and the time step [s] of the steps to come. Scene, state, time and account
  /// go on.
  /// @throw std::invalid_argument unless the time step is above 0 and finite.
  void stepBy(IntegrationMethod method, double time_step);

  /// Steps of the present time step: all of them, or none where memory runs out.
  void step(std::uint64_t steps = 1);

  /// Puts the particles, at rest, at `positions`, where a relaxation has brought them: one unit
  /// vector a particle, in the order of ids. Changes nothing, not even the account, where they are
  /// there and at rest already.
  void settle(const Points& positions);

  /// Puts back an earlier state of the same scene, with as many particles.
  void restore(State state);

  /// Returns the settings, with the method and the time step that were chosen last.
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
  void moved();
  void parametersChanged();
  void topologyChanged();

  Settings settings_;
  Scene scene_;
  mutable State state_;
  mutable bool integrator_is_ahead_ = false;  // of the state
  bool integrator_has_state_ = false;
  // Made when first needed after a change; the plan and the integrator outlive moves.
  std::shared_ptr<const Plan> plan_;
  std::shared_ptr<const Plan> earlier_plan_;  // of the same topology, with other parameters
  std::unique_ptr<Integrator> integrator_;
  std::shared_ptr<Account> account_;
  std::uint64_t revision_ = 0, topology_ = 0;
};

}  // namespace spherical_springs::core
