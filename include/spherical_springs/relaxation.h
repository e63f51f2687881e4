// Relaxation: from where the particles are to an equilibrium of the springs.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "spherical_springs/sphere.h"
#include "spherical_springs/system.h"

namespace spherical_springs::core {

/// Ways to a minimum of the energy.
enum class RelaxationMethod {
  newton,    ///< Newton's method on the sphere
  dynamics,  ///< damped stepping as in the report, with a step chosen by itself
  fire,      ///< the fast inertial relaxation engine, a quicker way of that
  global     ///< the lowest of several minima, by Newton's method and sweeps over the springs
};

/// Returns the method of a name: "newton", "dynamics", "fire", "global", or empty for the default,
/// newton.
/// @throw std::invalid_argument for any other name.
RelaxationMethod relaxationMethod(const std::string& name);

/// The outcome of a relaxation.
struct RelaxationResult {
  Points positions;              ///< one unit vector a particle, in the order of ids
  bool converged = false;        ///< the torque is within the tolerance, at a minimum of the energy
  std::uint32_t iterations = 0;  ///< that were finished
  double energy_before = 0;      ///< potential [J]
  double energy_after = 0;       ///< potential [J]
  double max_torque = 0;         ///< on a free particle [N m]
  std::string message;           ///< why it ended

  /// The number of rotations that take particles to other places without a change of the energy:
  /// for each group of free particles 3 if none is joined to a pinned one (2 where all lie on one
  /// axis), 1 if those all lie on one axis (0 where the group lies on it too), else 0.
  std::uint32_t free_rotations = 0;
  /// Whether the mirror image of a group of joined free particles has the same energy, and is not
  /// the group itself, turned, as where all lie on one great circle.
  bool mirror_ambiguous = false;
  /// The root of the mean square of all conditions, each weighted by its stiffness: the root of
  /// twice the energy over the stiffness of all springs in sum [rad, sr].
  double rms_strain = 0;
};

/// How far a relaxation has come.
struct RelaxationProgress {
  const RelaxationResult& best;  ///< what it would be if it ended now
  double fraction;               ///< of the way, from 0 to 1, by the logarithm of the torque
};

/// Choices of a relaxation.
struct RelaxationOptions {
  RelaxationMethod method = RelaxationMethod::newton;  ///< how it descends
  /// Largest torque left on a free particle [N m]. 0: on each particle 1e-9 of the stiffness that
  /// it feels, which is half the trace of its block of the definite Hessian and counts as at most
  /// 1e5 times the sum of its springs' stiffness; at least 1e-15 of the root of stiffness times
  /// sum, which bounds what rounding leaves.
  double tolerance = 0;
  double max_time = 0;  ///< wall [s]; 0: no limit
  /// For `global`: how often sweeps begin, at first at the present positions, then at random ones.
  std::uint32_t starts = 1;
  std::uint32_t seed = 0;  ///< for `global`: of all that is random
  /// Whether steps are cut before a triangle of a solid-angle spring would fold: one that is
  /// oriented as its rest angle asks, or that asks for none.
  bool keep_orientation = false;
  /// Called after every iteration; returning false ends the relaxation.
  std::function<bool(const RelaxationProgress&)> go_on = [](const auto&) { return true; };
};

/// @throw std::invalid_argument for a tolerance or time that is negative or not a number, and for
/// `global` without a start or with `keep_orientation`.
void requireValid(const RelaxationOptions& options);

/// The result of a relaxation that has not moved anything: energy and torque at `positions`, no
/// message.
RelaxationResult unrelaxed(const System& system, const Points& positions);

class Newton;

/// Relaxes one system after another. Reuses the last preconditioner if the start equals the last
/// result, the topology is unchanged and no stiffness has changed by more than a factor of 2. For
/// one thread at a time.
class Relaxer {
 public:
  Relaxer();  ///< with nothing prepared
  ~Relaxer();

  /// Moves free particles from `positions` to a minimum of the potential energy. A start on a
  /// saddle or a maximum is left, the same way every run; so is a place where a condition is
  /// undefined, or the message names its spring. What springs join is not turned as a whole: of all
  /// places that differ by a rotation the result is the nearest to `positions`. Particles without
  /// springs, and groups of joined particles that are relaxed already, keep their bits.
  /// @throw std::invalid_argument as `requireValid`.
  RelaxationResult relax(const System& system, const Points& positions,
                         const RelaxationOptions& options);

  /// Lets go of what is prepared for a start from the last result, and its memory.
  void forget();

 private:
  std::unique_ptr<Newton> newton_;
  Points last_end_;
};

/// Relaxes once, with a Relaxer of its own.
/// \snippet test_headers.cpp relaxation
RelaxationResult relax(const System& system, const Points& positions,
                       const RelaxationOptions& options);

}  // namespace spherical_springs::core
