#include "spherical_springs/system.h"

#include <cmath>

#include "parallel.h"

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
  damping_.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Particle& particle = particles.item(i);
    masses_[i] = particle.mass;
    inverse_masses_[i] = particle.pinned ? 0 : 1 / particle.mass;
    damping_[i] = particle.damping;
    any_pinned_ = any_pinned_ || particle.pinned;
    particles_damped_ = particles_damped_ || (particle.damping > 0 && !particle.pinned);
  }

  first_end_.assign(count + 1, 0);
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    auto& springs = springs_.get<Spring>();
    springs.reserve(scene.springs<Spring>().size());
    for (Spring spring : scene.springs<Spring>().items()) {
      for (std::uint32_t& end : spring.particles) {
        end = static_cast<std::uint32_t>(*particles.find(end));
        ++first_end_[end + 1];
      }
      if (spring.damping > 0) {
        damped_springs_.get<Spring>().springs.push_back(springs.size());
        springs_damped_ = true;
      }
      springs.push_back(spring);
    }
    end_count_ += springs.size() * Spring::kParticles;
  });

  for (Eigen::Index i = 0; i < count; ++i) first_end_[i + 1] += first_end_[i];
  std::vector<std::uint32_t> next(first_end_.begin(), first_end_.end() - 1);
  ends_.resize(end_count_);
  std::uint32_t slot = 0;
  forEachKind([&](auto kind) {
    for (const auto& spring : springs<typename decltype(kind)::type>()) {
      for (const std::uint32_t end : spring.particles) ends_[next[end]++] = slot++;
    }
  });
}

bool System::conservesAngularMomentum() const {
  const bool damped_alone =
      particles_damped_ || (springs_damped_ && options_.spring_damping == SpringDamping::own);
  return !any_pinned_ && !damped_alone;
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
  if (springs_damped_) workspace.end_gradients.resize(end_count_);
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
        if (springs_damped_) workspace.end_gradients[slot] = c.gradient[j];
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

double System::damp(const Workspace& workspace, double duration,
                    Points& angular_velocities) const {
  double taken = 0;
  if (particles_damped_) taken += dampViscously(duration / 2, angular_velocities);
  if (springs_damped_) {
    taken += dampSprings(workspace, duration / 2, false, angular_velocities);
    taken += dampSprings(workspace, duration / 2, true, angular_velocities);
  }
  if (particles_damped_) taken += dampViscously(duration / 2, angular_velocities);
  return taken;
}

double System::dampViscously(double duration, Points& angular_velocities) const {
  double taken = 0;
  for (Eigen::Index i = 0; i < particleCount(); ++i) {
    const double exponent = -damping_[i] * inverse_masses_[i] * duration;
    if (exponent == 0) continue;
    auto velocity = angular_velocities.col(i);
    taken -= 0.5 * masses_[i] * velocity.squaredNorm() * std::expm1(2 * exponent);
    velocity *= std::exp(exponent);
  }
  return taken;
}

namespace {

/// The exact flow of one damper on some ends: the rate of its condition decays exponentially.
struct Damper {
  double rate = 0;      ///< sum of gradient . omega
  double mobility = 0;  ///< sum of |gradient|^2 / mass

  void add(const Vector3& gradient, const Vector3& velocity, double inverse_mass) {
    rate += gradient.dot(velocity);
    mobility += gradient.squaredNorm() * inverse_mass;
  }
  /// Impulse along the gradients over `duration` for the coefficient `damping`.
  double impulse(double damping, double duration) const {
    return mobility > 0 ? rate * std::expm1(-damping * mobility * duration) / mobility : 0;
  }
  double energyTaken(double damping, double duration) const {
    if (mobility == 0) return 0;
    return -0.5 * rate * rate * std::expm1(-2 * damping * mobility * duration) / mobility;
  }
};

}  // namespace

double System::dampSprings(const Workspace& workspace, double duration, bool backward,
                           Points& angular_velocities) const {
  double taken = 0;
  const auto dampEnds = [&](const std::uint32_t* particles, const Vector3* gradients, int count,
                            double damping) {
    Damper damper;
    for (int j = 0; j < count; ++j) {
      damper.add(gradients[j], angular_velocities.col(particles[j]), inverse_masses_[particles[j]]);
    }
    const double impulse = damper.impulse(damping, duration);
    taken += damper.energyTaken(damping, duration);
    for (int j = 0; j < count; ++j) {
      angular_velocities.col(particles[j]) +=
          impulse * inverse_masses_[particles[j]] * gradients[j];
    }
  };
  const auto dampSpring = [&](const auto& spring, const Vector3* gradients) {
    constexpr int kEnds = std::decay_t<decltype(spring)>::kParticles;
    const std::uint32_t* particles = spring.particles.data();
    if (options_.spring_damping == SpringDamping::relative) {
      return dampEnds(particles, gradients, kEnds, spring.damping);
    }
    for (int j = 0; j < kEnds; ++j) dampEnds(particles + j, gradients + j, 1, spring.damping);
  };

  std::size_t offset = backward ? end_count_ : 0;
  const auto dampKind = [&](auto kind) {
    using Spring = typename decltype(kind)::type;
    const auto& list = springs<Spring>();
    const auto& damped = damped_springs_.get<Spring>().springs;
    const std::size_t ends = list.size() * Spring::kParticles;
    if (backward) offset -= ends;
    for (std::size_t n = 0; n < damped.size(); ++n) {
      const std::uint32_t s = damped[backward ? damped.size() - 1 - n : n];
      dampSpring(list[s], &workspace.end_gradients[offset + s * Spring::kParticles]);
    }
    if (!backward) offset += ends;
  };
  backward ? forEachKindBackward(dampKind) : forEachKind(dampKind);
  return taken;
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
