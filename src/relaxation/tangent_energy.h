// The energy of a system as a function on the tangent planes of its free particles.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "linear/block_matrix.h"
#include "relaxation/group_units.h"
#include "relaxation/tangent_places.h"
#include "spherical_springs/system.h"

namespace spherical_springs::core {

/// The energy of each group of free particles that springs join is in the group's unit
/// (`GroupUnits`), so that single precision holds every Hessian and no group is lost in the
/// rounding of another. With inertia all free particles are one group. Free particles come in an
/// order of their own, in which those that are joined are close; the unknowns 2 f and 2 f + 1 are
/// the coordinates of free particle f in a tangent frame of its own.
class TangentEnergy {
 public:
  using Hessian = Blocks<double, 2>;

  /// `positions`: for the order only. `inertia`: [J/rad^2], one a particle, on the squared distance
  /// from a target; none in a relaxation.
  TangentEnergy(const System& system, const Points& positions, Eigen::VectorXd inertia = {});

  /// Whether the same springs, whatever their rest and about as stiff, join the same particles in
  /// `system`, and the same are pinned.
  bool fits(const System& system) const;
  /// Takes rest and stiffness from a system that fits.
  void take(const System& system);

  double unit(std::size_t free) const { return units_.of(free); }  ///< of its group [J]
  const BlockPattern& pattern() const { return pattern_; }
  std::size_t freeCount() const { return pattern_.rows(); }

  /// Puts the particles somewhere; `evaluate` is to follow.
  void place(const Points& positions);
  /// Puts the particles somewhere, with frames carried along from where they were.
  void carry(const Points& positions);
  void setTargets(const Points& targets);

  /// Moves the free particles as `TangentPlaces` has it; `evaluate` is to follow.
  void move(const Eigen::VectorXd& step) { places_.move(step); }
  /// Keeps the places of the particles, to go back to.
  void mark() { places_.mark(); }
  void goBack() { places_.goBack(); }

  /// Value, gradient and Hessian where the particles are.
  void evaluate(Curvature curvature);

  /// Sum over the groups, each in its unit. Springs between pinned particles are left out.
  double value() const { return value_; }
  /// Energy of all springs, and the inertia's [J].
  double energy() const;
  const Eigen::VectorXd& gradient() const { return gradient_; }
  const Hessian& hessian() const { return hessian_; }
  /// The drop of the energy that the quadratic model of the last evaluation foretells for a step.
  double expectedDrop(const Eigen::VectorXd& step) const;

  /// Largest gradient of a free particle, which is its torque [N m].
  double maxTorque() const;

  /// For each free particle the longest chord to another that a spring joins it with, or 1 where
  /// there is none.
  Eigen::VectorXd reach() const;

  /// Returns where the particles are, to read.
  const TangentPlaces& places() const { return places_; }
  /// Particle of each free one.
  std::uint32_t particle(std::size_t free) const { return order().particles[free]; }

 private:
  const ParticleOrder& order() const { return places_.order(); }

  template <class Spring>
  struct Compiled {
    std::vector<Spring> springs;         ///< whose particles are numbers in the order here
    std::vector<std::uint32_t> sources;  ///< their indices in the system
    std::vector<std::array<std::uint32_t, Spring::kParticles * Spring::kParticles>> places;
    /// Index of the first spring of each block of the pattern, and the end. Springs after that join
    /// pinned particles alone.
    std::vector<std::uint32_t> first;
  };

  template <class Spring>
  void compile(const System& system);
  template <class Spring>
  double unitOf(const Spring& spring) const;
  template <class Spring>
  std::array<Vector3, Spring::kParticles> pointsOf(const Spring& spring) const;
  template <class Spring>
  double add(const Compiled<Spring>& compiled, std::size_t block, Curvature curvature);
  template <class Spring>
  double addOne(const Compiled<Spring>& compiled, std::size_t spring, Curvature curvature);
  void addInertia(Curvature curvature);
  void findPinnedEnergy();

  int threads_;
  TangentPlaces places_;
  BlockPattern pattern_;
  Schedule far_apart_;  // of the pattern's blocks
  PerKind<Compiled> compiled_;
  GroupUnits units_;
  Eigen::VectorXd inertia_;
  std::vector<Vector3> targets_;
  double value_ = 0;
  double pinned_energy_ = 0;  // [J]
  Eigen::VectorXd gradient_;
  Hessian hessian_;
  std::vector<double> block_values_;
};

}  // namespace spherical_springs::core
