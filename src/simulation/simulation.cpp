#include "spherical_springs/simulation.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "simulation/step_choice.h"
#include "spherical_springs/range.h"

namespace spherical_springs::core {
namespace {

void place(const Particle& particle, Eigen::Index i, State& state) {
  state.positions.col(i) = particle.position;
  state.angular_velocities.col(i) = particle.angular_velocity;
}

/// Every particle of a scene where it was last added or set, time 0.
State startOf(const Scene& scene) {
  const auto& particles = scene.particles().items();
  State state;
  state.positions.resize(3, particles.size());
  state.angular_velocities.resize(3, particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i) place(particles[i], i, state);
  return state;
}

bool anyOf(const SpringIds& ids) {
  bool any = false;
  forEachKind([&](auto kind) { any = any || !ids.get<typename decltype(kind)::type>().empty(); });
  return any;
}

}  // namespace

void StepWish::requireValid() const {
  if (!(time_step > 0 && std::isfinite(time_step))) {
    throw std::invalid_argument("time_step is " + toText(time_step) + "; allowed: above 0 [s]");
  }
  if (!(accuracy >= 0 && std::isfinite(accuracy))) {
    throw std::invalid_argument("accuracy is " + toText(accuracy) +
                                "; allowed: 0 (off) or above [rad/s]");
  }
  if (chooses_method && accuracy == 0) {
    throw std::invalid_argument(
        "accuracy is 0, by which no method can be chosen; allowed: above 0 [rad/s], or a method");
  }
}

bool StepWish::asksTheSameAs(const StepWish& other) const {
  return method == other.method && accuracy == other.accuracy &&
         chooses_method == other.chooses_method && (accuracy > 0 || time_step == other.time_step);
}

Simulation::Simulation(const Settings& settings)
    : settings_(settings), scene_(settings.limits), state_(startOf(scene_)) {
  settings_.requireValid();
  choice_.method = settings_.method;
  choice_.time_step = settings_.time_step;
}

const State& Simulation::state() const {
  if (integrator_is_ahead_) integrator_->give(state_);
  integrator_is_ahead_ = false;
  return state_;
}

/// The present state, which the integrator is to take over anew.
State& Simulation::changeState() {
  state();
  integrator_has_state_ = false;
  ++revision_;
  return state_;
}

/// Follows a change of positions and velocities, under which the plan holds.
void Simulation::moved() {
  State& state = changeState();
  state.dissipated = 0;
  state.divided_steps = 0;
  state.shortest = {};
  account_.reset();
  choice_holds_ = false;
}

/// Follows a change of numbers of particles or springs, under which these join as before.
void Simulation::parametersChanged() {
  moved();
  if (plan_) earlier_plan_ = std::move(plan_);
  plan_.reset();
  integrator_.reset();
}

/// Follows a change of anything else.
void Simulation::topologyChanged() {
  parametersChanged();
  earlier_plan_.reset();
  ++topology_;
}

std::vector<std::uint32_t> Simulation::addParticles(std::vector<Particle> particles) {
  if (particles.empty()) return {};
  const auto before = state().positions.cols();
  const auto count = before + static_cast<Eigen::Index>(particles.size());
  State grown = state_;
  grown.positions.conservativeResize(Eigen::NoChange, count);
  grown.angular_velocities.conservativeResize(Eigen::NoChange, count);
  auto ids = scene_.addParticles(std::move(particles));
  for (Eigen::Index i = before; i < count; ++i) place(scene_.particles().item(i), i, grown);
  state_ = std::move(grown);
  topologyChanged();
  return ids;
}

void Simulation::setParticles(const std::vector<std::uint32_t>& ids,
                              std::vector<Particle> particles) {
  const auto [indices, only_moved] = scene_.setParticles(ids, std::move(particles));
  if (indices.empty()) return;
  for (const std::size_t i : indices) place(scene_.particles().item(i), i, changeState());
  only_moved ? moved() : parametersChanged();
}

std::size_t Simulation::removeParticles(const std::vector<std::uint32_t>& ids) {
  if (ids.empty()) return 0;
  const Scene::Removal removal = scene_.removeParticles(ids);
  State& state = changeState();
  Eigen::Index kept = 0;
  for (std::size_t i = 0; i < removal.particles.size(); ++i) {
    if (removal.particles[i]) continue;
    state.positions.col(kept) = state.positions.col(i);
    state.angular_velocities.col(kept) = state.angular_velocities.col(i);
    ++kept;
  }
  state.positions.conservativeResize(Eigen::NoChange, kept);
  state.angular_velocities.conservativeResize(Eigen::NoChange, kept);
  topologyChanged();
  return removal.springs;
}

SpringIds Simulation::addSprings(SpringLists springs) {
  SpringIds ids = scene_.addSprings(std::move(springs), state().positions);
  if (anyOf(ids)) topologyChanged();
  return ids;
}

void Simulation::setSprings(const SpringIds& ids, SpringLists springs) {
  const bool same_particles = scene_.setSprings(ids, std::move(springs), state().positions);
  if (!anyOf(ids)) return;
  same_particles ? parametersChanged() : topologyChanged();
}

void Simulation::removeSprings(const SpringIds& ids) {
  scene_.removeSprings(ids);
  if (anyOf(ids)) topologyChanged();
}

void Simulation::clear() {
  scene_.clear();
  beginAt(startOf(scene_));
}

void Simulation::reset() {
  changeState() = startOf(scene_);
  moved();
}

void Simulation::load(SceneFile file) {
  State start = startOf(file.scene);
  start.time = file.time;
  file.scene.reserveIdsOf(scene_);
  scene_ = std::move(file.scene);
  beginAt(std::move(start));
}

void Simulation::beginAt(State start) {
  changeState() = std::move(start);
  topologyChanged();
}

// Chosen at once, so that what fails leaves all as it was.
void Simulation::stepBy(const StepWish& wish) {
  wish.requireValid();
  const StepChoice choice = chosenFor(wish);
  static_cast<StepWish&>(settings_) = wish;
  adopt(choice);
}

const StepChoice& Simulation::choice() {
  if (!choice_holds_) {
    adopt(chosenFor(settings_));
  } else if (choice_.steps_to_review == 0) {
    adopt(reviewedSteps(plan(), settings_, state(), choice_));
  }
  return choice_;
}

StepChoice Simulation::chosenFor(const StepWish& wish) {
  if (wish.accuracy == 0) return {wish.method, wish.time_step};
  return chooseSteps(plan(), wish, state());
}

void Simulation::adopt(const StepChoice& choice) {
  if (choice.method != choice_.method || choice.time_step != choice_.time_step) {
    state();
    integrator_has_state_ = false;
    integrator_.reset();
  }
  choice_ = choice;
  choice_holds_ = true;
}

void Simulation::step(std::uint64_t steps) {
  account();  // begins before anything moves
  if (steps <= choice().steps_to_review) return stepAtOnce(steps);
  Moment before = moment();
  try {
    while (steps > 0) {
      const std::uint64_t part = std::min(steps, choice().steps_to_review);
      stepAtOnce(part);
      steps -= part;
    }
  } catch (...) {
    restore(std::move(before));
    throw;
  }
}

/// Steps up to the next review.
void Simulation::stepAtOnce(std::uint64_t steps) {
  if (!integrator_) integrator_ = makeIntegrator(plan(), choice_.method, choice_.time_step);
  if (!integrator_has_state_) integrator_->take(state_);
  integrator_has_state_ = true;
  integrator_->advance(steps);
  integrator_is_ahead_ = true;
  ++revision_;
  if (settings_.accuracy > 0) choice_.steps_to_review -= steps;
}

void Simulation::settle(const Points& positions) {
  if (state().angular_velocities.isZero(0) && state_.positions == positions) return;
  State& state = changeState();
  state.positions = positions;
  state.angular_velocities.setZero();
  moved();
}

Simulation::Moment Simulation::moment() {
  const StepChoice choice = this->choice();
  return {state(), choice};
}

void Simulation::restore(Moment moment) {
  integrator_is_ahead_ = false;
  adopt(moment.choice);
  state_ = std::move(moment.state);
  integrator_has_state_ = false;
  ++revision_;
}

Scene Simulation::presentScene() const {
  Scene present = scene_;
  present.place(state().positions, state().angular_velocities);
  return present;
}

std::shared_ptr<const Plan> Simulation::plan() {
  if (!plan_) {
    plan_ = earlier_plan_ ? std::make_shared<const Plan>(scene_, settings_.system, *earlier_plan_)
                          : std::make_shared<const Plan>(scene_, settings_.system);
    earlier_plan_.reset();
  }
  return plan_;
}

std::shared_ptr<Account> Simulation::account() {
  if (!account_) account_ = std::make_shared<Account>(*plan(), state());
  return account_;
}

std::shared_ptr<Account> Simulation::begin(std::shared_ptr<Account> account,
                                           std::uint64_t revision) {
  if (revision != revision_) return account;
  if (!account_) account_ = std::move(account);
  return account_;
}

}  // namespace spherical_springs::core
