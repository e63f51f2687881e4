// Stepping through time.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "spherical_springs/plan.h"
#include "spherical_springs/state.h"

namespace spherical_springs::core {

/// Methods of stepping; doc/mathematics.md says more of each.
enum class IntegrationMethod {
  euler,          ///< the report's (section 5): speed first, then position; first order, symplectic
  verlet,         ///< Strang's splitting; second order, symplectic
  fourth_order,   ///< Blanes and Moan's splitting; symplectic
  implicit_euler  ///< first order; stable for any step, and takes energy out
};

/// Returns the method of a name: "euler", "verlet", "fourth_order" or "implicit_euler".
/// @throw std::invalid_argument for any other name.
IntegrationMethod integrationMethod(const std::string& name);

/// Returns the name of a method, as `integrationMethod` takes it.
const char* nameOf(IntegrationMethod method);

/// Order of accuracy of the method in the time step.
int orderOf(IntegrationMethod method);

/// Largest product of a frequency [rad/s] and a time step [s] that the method bears; infinite for
/// implicit_euler.
double stabilityLimit(IntegrationMethod method);

/// Whether the method loses energy of its own, apart from damping.
bool takesEnergyOut(IntegrationMethod method);

/// Owns a copy of the state in a memory layout of its own; `give` converts it back. Equal numbers
/// of steps give equal bits, however they are cut into calls and whatever is read in between.
/// \snippet test_headers.cpp integrator
class Integrator {
 public:
  virtual ~Integrator() = default;

  /// Takes over a state.
  virtual void take(const State& state) = 0;

  /// Takes so many steps of the state: all of them, or none where it throws.
  virtual void advance(std::uint64_t steps) = 0;

  /// Puts the present state into `state`.
  virtual void give(State& state) const = 0;

  /// One step of a state.
  void step(State& state) {
    take(state);
    advance(1);
    give(state);
  }
};

/// Makes an integrator of a method, with all the memory that its steps need. `time_step`: [s],
/// above 0.
/// @throw std::bad_alloc.
std::unique_ptr<Integrator> makeIntegrator(const std::shared_ptr<const Plan>& plan,
                                           IntegrationMethod method, double time_step);

}  // namespace spherical_springs::core
