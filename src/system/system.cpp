#include "spherical_springs/system.h"

#include <cmath>

#include "base/parallel.h"

namespace spherical_springs::core {

double PotentialEnergies::total() const {
  double sum = 0;
  forEachKind([&](auto kind) { sum += get<typename decltype(kind)::type>().joules; });
  return sum;
}

System::System(const Scene& scene, Options options) : options_(options) {
  const auto& particles = scene.particles();
  const auto count = static_cast<Eigen::Index>(particles.size());
  masses_.resize(count);
  inverse_masses_.resize(count);
  Values viscous(count);
  particle_ids_ = particles.ids();
  for (Eigen::Index i = 0; i < count; ++i) {
    const Particle& particle = particles.item(i);
    masses_[i] = particle.mass;
    inverse_masses_[i] = particle.pinned ? 0 : 1 / particle.mass;
    viscous[i] = particle.damping;
    any_pinned_ = any_pinned_ || particle.pinned;
  }

  std::vector<Damping::Damper> dampers;
  first_end_.assign(count + 1, 0);
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    auto& springs = springs_.get<Spring>();
    springs.reserve(scene.springs<Spring>().size());
    const auto& ids = scene.springs<Spring>().ids();
    spring_ids_.get<Spring>().assign(ids.begin(), ids.end());
    for (Spring spring : scene.springs<Spring>().items()) {
      for (std::uint32_t& end : spring.particles) {
        end = static_cast<std::uint32_t>(*particles.find(end));
        ++first_end_[end + 1];
      }
      if (spring.damping > 0) addDampers(spring, dampers);
      springs.push_back(spring);
      end_count_ += Spring::kParticles;
    }
  });

  for (Eigen::Index i = 0; i < count; ++i) first_end_[i + 1] += first_end_[i];
  std::vector<std::uint32_t> next(first_end_.begin(), first_end_.end() - 1);
  ends_.resize(end_count_);
  std::vector<std::uint32_t> end_particles;
  forEachKind([&](auto kind) {
    for (const auto& spring : springs<typename decltype(kind)::type>()) {
      for (const std::uint32_t particle : spring.particles) {
        ends_[next[particle]++] = static_cast<std::uint32_t>(end_particles.size());
        end_particles.push_back(particle);
      }
    }
  });
  if (dampers.empty()) end_particles.clear();
  damping_ = Damping(inverse_masses_, viscous, std::move(dampers), std::move(end_particles));
}

template <class Spring>
void System::addDampers(const Spring& spring, std::vector<Damping::Damper>& dampers) const {
  const auto first_end = static_cast<std::uint32_t>(end_count_);
  if (options_.spring_damping == SpringDamping::relative) {
    dampers.push_back({first_end, Spring::kParticles, spring.damping});
    return;
  }
  for (std::uint32_t j = 0; j < Spring::kParticles; ++j) {
    dampers.push_back({first_end + j, 1, spring.damping});
  }
}

bool System::conservesAngularMomentum() const {
  const bool by_parts = damping_.hasDampers() && options_.spring_damping == SpringDamping::own;
  return !any_pinned_ && !damping_.hasViscous() && !by_parts;
}

double System::largestStiffness() const {
  double largest = 0;
  forEachKind([&](auto kind) {
    for (const auto& spring : springs<typename decltype(kind)::type>()) {
      largest = std::max(largest, spring.stiffness);
    }
  });
  return largest;
}

void System::evaluate(const Points& positions, Workspace& workspace) const {
  workspace.end_torques.resize(end_count_);
  const bool keep_gradients = damping_.hasDampers();
  if (keep_gradients) workspace.end_gradients.resize(end_count_);
  std::size_t offset = 0;
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    const auto& list = springs<Spring>();
    parallelFor(list.size(), options_.threads, [&](std::ptrdiff_t s) {
      const auto c = condition(list[s], points(list[s], positions));
      const double pull = -list[s].stiffness * c.value;
      for (std::size_t j = 0; j < Spring::kParticles; ++j) {
        const std::size_t slot = offset + s * Spring::kParticles + j;
        workspace.end_torques[slot] = pull * c.gradient[j];
        if (keep_gradients) workspace.end_gradients[slot] = c.gradient[j];
      }
    });
    offset += list.size() * Spring::kParticles;
  });

  workspace.torques.resize(3, particleCount());
  parallelFor(particleCount(), options_.threads, [&](std::ptrdiff_t i) {
    Vector3 torque = Vector3::Zero();
    for (std::uint32_t e = first_end_[i]; e < first_end_[i + 1]; ++e) {
      torque += workspace.end_torques[ends_[e]];
    }
    workspace.torques.col(i) = torque;
  });
}

PotentialEnergies System::potential(const Points& positions) const {
  PotentialEnergies energies;
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    const auto& list = springs<Spring>();
    energies.get<Spring>().joules =
        parallelSum(list.size(), options_.threads, [&](std::ptrdiff_t s) {
          const double c = condition(list[s], points(list[s], positions)).value;
          return 0.5 * list[s].stiffness * c * c;
        });
  });
  return energies;
}

double System::kinetic(const Points& angular_velocities) const {
  return 0.5 * angular_velocities.colwise().squaredNorm().dot(masses_.transpose());
}

Vector3 System::angularMomentum(const Points& angular_velocities) const {
  return angular_velocities * masses_;
}

}  // namespace spherical_springs::core
