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
class Simulation {
 public:
  struct Settings {
    IntegrationMethod method = IntegrationMethod::verlet;
    double time_step = 0.001;  ///< [s]
    System::Options system;
    SceneLimits limits;
  };

  explicit Simulation(const Settings& settings);

  std::vector<std::uint32_t> addParticles(std::vector<Particle> particles);
  void setParticles(const std::vector<std::uint32_t>& ids, std::vector<Particle> particles);
  std::size_t removeParticles(const std::vector<std::uint32_t>& ids);  ///< @return springs removed
  SpringIds addSprings(SpringLists springs);
  void setSprings(const SpringIds& ids, SpringLists springs);
  void removeSprings(const SpringIds& ids);

  void clear();               ///< No particles, no springs, time 0.
  void reset();               ///< Every particle where it was last added or set, time 0.
  void load(SceneFile file);  ///< In place of the present scene.

  /// Steps of the settings' time step: all of them, or none where memory runs out.
  void step(std::uint64_t steps = 1);

  /// Puts the particles, at rest, where a relaxation has brought them. Changes nothing, not even
  /// the account, where they are there and at rest already.
  void settle(const Points& positions);

  /// Puts back an earlier state of the same scene.
  void restore(State state);

  const Settings& settings() const { return settings_; }
  const Scene& scene() const { return scene_; }
  const State& state() const;
  Scene presentScene() const;  ///< with the particles where they are now

  std::shared_ptr<const Plan> plan();
  std::shared_ptr<Account> account();

  /// The account without making it: null until something has asked for it.
  std::shared_ptr<Account> begunAccount() const { return account_; }

  /// A number that changes with everything that moves or changes the scene.
  std::uint64_t revision() const { return revision_; }

  /// Offers an account that was made of the state at `revision`.
  /// @return the account of that state: the one there was, or the one offered, which is taken
  /// unless the state has changed since.
  std::shared_ptr<Account> begin(std::shared_ptr<Account> account, std::uint64_t revision);

 private:
  State& changeState();
  void beginAt(State start);
  void moved();
  void changed();

  Settings settings_;
  Scene scene_;
  mutable State state_;
  mutable bool integrator_is_ahead_ = false;  // of the state
  bool integrator_has_state_ = false;
  // Made when first needed after a change; the plan and the integrator outlive moves.
  std::shared_ptr<const Plan> plan_;
  std::unique_ptr<Integrator> integrator_;
  std::shared_ptr<Account> account_;
  std::uint64_t revision_ = 0;
};

}  // namespace spherical_springs::core
