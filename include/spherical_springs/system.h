// The system compiled from a scene: arrays by kind, only the kinds present.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "spherical_springs/damping.h"
#include "spherical_springs/scene.h"
#include "spherical_springs/sphere.h"
#include "spherical_springs/springs/kinds.h"

namespace spherical_springs::core {

/// Whose velocity a spring's damping acts on: that of the whole spring, dC/dt, or each particle's
/// own part of it (report's equation 5, with c = k_d / 4).
enum class SpringDamping { relative, own };

/// Energy stored in the springs of one kind.
template <class Spring>
struct EnergyOf {
  double joules = 0;  ///< [J]
};

/// Energy stored in the springs of each kind.
struct PotentialEnergies : PerKind<EnergyOf> {
  double total() const;  ///< [J]
};

/// Unchanging once made, so that many threads may use it. Particles and springs stand in the order
/// of their ids, and springs name particles by index.
/// \snippet test_headers.cpp system
class System {
 public:
  /// Choices that concern all springs and particles.
  struct Options {
    SpringDamping spring_damping = SpringDamping::relative;  ///< of all damped springs
    int threads = 1;  ///< results do not depend on it, to the last bit
  };

  /// Compiles a scene. `options.threads`: at least 1.
  System(const Scene& scene, Options options);

  Eigen::Index particleCount() const { return masses_.size(); }    ///< pinned ones among them
  const Values& masses() const { return masses_; }                 ///< [kg]
  const Values& inverseMasses() const { return inverse_masses_; }  ///< [1/kg], 0 where pinned
  /// Whether a particle never moves by itself.
  bool pinned(Eigen::Index particle) const { return inverse_masses_[particle] == 0; }
  /// Whether a spring ends at a particle.
  bool joined(Eigen::Index particle) const {
    return first_end_[particle] < first_end_[particle + 1];
  }
  const Damping& damping() const { return damping_; }  ///< of particles and springs
  SpringDamping springDamping() const { return options_.spring_damping; }  ///< as was chosen
  /// Whether nothing turns the scene as a whole: no pins, and no damping but between particles.
  bool conservesAngularMomentum() const;
  double largestStiffness() const;  ///< of all kinds [J/rad^2, J/sr^2]; 0 without springs
  int threads() const { return options_.threads; }  ///< for loops over springs or particles

  /// Id of a particle, by its index.
  std::uint32_t particleId(std::size_t index) const { return particle_ids_[index]; }
  /// Id of a spring of a kind, by its index in `springs`.
  template <class Spring>
  std::uint32_t springId(std::size_t index) const {
    return spring_ids_.get<Spring>()[index];
  }

  /// Springs of a kind, whose `particles` are indices.
  template <class Spring>
  const SpringList<Spring>& springs() const {
    return springs_.get<Spring>();
  }

  /// Arrays of an evaluation at some positions, reused to save memory.
  struct Workspace {
    std::vector<Vector3> end_torques;    ///< of each end of each spring [N m]
    std::vector<Vector3> end_gradients;  ///< of each end of each spring, if any spring is damped
    Points torques;                      ///< of each particle [N m]
  };

  /// Puts the torques of the springs on each particle, damping apart, into `workspace`.
  /// `positions`: one unit vector a particle.
  void evaluate(const Points& positions, Workspace& workspace) const;

  /// Returns the energies of the springs; `positions`: one unit vector a particle.
  PotentialEnergies potential(const Points& positions) const;
  /// Returns the kinetic energy [J] of angular velocities [rad/s], one a particle.
  double kinetic(const Points& angular_velocities) const;

  /// Sum of m omega [kg m^2 rad/s].
  Vector3 angularMomentum(const Points& angular_velocities) const;

  /// Returns the positions of the particles of a spring, whose `particles` are indices.
  template <class Spring>
  static std::array<Vector3, Spring::kParticles> points(const Spring& spring,
                                                        const Points& positions) {
    std::array<Vector3, Spring::kParticles> result;
    for (std::size_t j = 0; j < Spring::kParticles; ++j) {
      result[j] = positions.col(spring.particles[j]);
    }
    return result;
  }

 private:
  template <class Spring>
  void addDampers(const Spring& spring, std::vector<Damping::Damper>& dampers) const;

  Options options_;
  Values masses_, inverse_masses_;
  bool any_pinned_ = false;
  SpringLists springs_;
  std::vector<std::uint32_t> particle_ids_;
  SpringIds spring_ids_;
  Damping damping_;
  std::size_t end_count_ = 0;
  // The ends of springs at each particle: those of particle i are at ends_[first_end_[i]] and on,
  // so that torques are summed in the same order however many threads do it.
  std::vector<std::uint32_t> first_end_, ends_;
};

}  // namespace spherical_springs::core
