#include "spherical_springs/simulation.h"

#include <utility>

namespace spherical_springs::core {

void Simulation::changed() {
  system_.reset();
  integrator_.reset();
  account_.reset();
  state_.dissipated = 0;
}

std::vector<std::uint32_t> Simulation::addParticles(std::vector<Particle> particles) {
  auto ids = scene_.addParticles(std::move(particles));
  const auto before = state_.positions.cols();
  const auto count = static_cast<Eigen::Index>(scene_.particles().size());
  state_.positions.conservativeResize(Eigen::NoChange, count);
  state_.angular_velocities.conservativeResize(Eigen::NoChange, count);
  for (Eigen::Index i = before; i < count; ++i) {
    state_.positions.col(i) = scene_.particles().item(i).position;
    state_.angular_velocities.col(i) = scene_.particles().item(i).angular_velocity;
  }
  changed();
  return ids;
}

void Simulation::setParticles(const std::vector<std::uint32_t>& ids,
                              std::vector<Particle> particles) {
  for (const std::size_t i : scene_.setParticles(ids, std::move(particles))) {
    state_.positions.col(i) = scene_.particles().item(i).position;
    state_.angular_velocities.col(i) = scene_.particles().item(i).angular_velocity;
  }
  changed();
}

std::size_t Simulation::removeParticles(const std::vector<std::uint32_t>& ids) {
  const Scene::Removal removal = scene_.removeParticles(ids);
  Eigen::Index kept = 0;
  for (std::size_t i = 0; i < removal.particles.size(); ++i) {
    if (removal.particles[i]) continue;
    state_.positions.col(kept) = state_.positions.col(i);
    state_.angular_velocities.col(kept) = state_.angular_velocities.col(i);
    ++kept;
  }
  state_.positions.conservativeResize(Eigen::NoChange, kept);
  state_.angular_velocities.conservativeResize(Eigen::NoChange, kept);
  changed();
  return removal.springs;
}

SpringIds Simulation::addSprings(SpringLists springs) {
  SpringIds ids = scene_.addSprings(std::move(springs), state_.positions);
  changed();
  return ids;
}

void Simulation::setSprings(const SpringIds& ids, SpringLists springs) {
  scene_.setSprings(ids, std::move(springs), state_.positions);
  changed();
}

void Simulation::removeSprings(const SpringIds& ids) {
  scene_.removeSprings(ids);
  changed();
}

void Simulation::clear() {
  scene_.clear();
  placeAtStart();
}

void Simulation::reset() { placeAtStart(); }

void Simulation::load(SceneFile file) {
  file.scene.reserveIdsOf(scene_);
  scene_ = std::move(file.scene);
  placeAtStart();
  state_.time = file.time;
}

void Simulation::placeAtStart() {
  const auto& particles = scene_.particles().items();
  state_ = State();
  state_.positions.resize(3, particles.size());
  state_.angular_velocities.resize(3, particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i) {
    state_.positions.col(i) = particles[i].position;
    state_.angular_velocities.col(i) = particles[i].angular_velocity;
  }
  changed();
}

void Simulation::step() {
  account();  // begins before anything moves
  if (!integrator_) {
    integrator_ = makeIntegrator(system(), settings_.method, settings_.time_step);
  }
  integrator_->step(state_);
}

void Simulation::settle(const Points& positions) {
  state_.positions = positions;
  state_.angular_velocities.setZero();
  state_.dissipated = 0;
  account_.reset();
}

void Simulation::restore(State state, std::shared_ptr<Account> account) {
  state_ = std::move(state);
  account_ = std::move(account);
}

Scene Simulation::presentScene() const {
  Scene present = scene_;
  present.place(state_.positions, state_.angular_velocities);
  return present;
}

std::shared_ptr<const System> Simulation::system() {
  if (!system_) system_ = std::make_shared<const System>(scene_, settings_.system);
  return system_;
}

std::shared_ptr<Account> Simulation::account() {
  if (!account_) account_ = std::make_shared<Account>(*system(), state_);
  return account_;
}

}  // namespace spherical_springs::core
