// Stepping through time.
#pragma once

#include <memory>
#include <string>

#include "spherical_springs/state.h"
#include "spherical_springs/system.h"

namespace spherical_springs::core {

enum class IntegrationMethod {
  euler,          ///< the report's (section 5): speed first, then position; first order, symplectic
  verlet,         ///< Strang's splitting; second order, symplectic
  fourth_order,   ///< Blanes and Moan's splitting; symplectic
  implicit_euler  ///< first order; stable for any step, and takes energy out
};

/// `name`: "euler", "verlet", "fourth_order" or "implicit_euler".
/// @throw std::invalid_argument for any other name.
IntegrationMethod integrationMethod(const std::string& name);

int orderOf(IntegrationMethod method);

/// Largest product of a frequency [rad/s] and a time step [s] that the method bears; infinite for
/// implicit_euler.
double stabilityLimit(IntegrationMethod method);

class Integrator {
 public:
  virtual ~Integrator() = default;

  /// One step. A function of the state alone, so that the same steps give the same bits however
  /// they are cut into calls.
  virtual void step(State& state) = 0;
};

/// `time_step`: [s], above 0.
std::unique_ptr<Integrator> makeIntegrator(std::shared_ptr<const System> system,
                                           IntegrationMethod method, double time_step);

}  // namespace spherical_springs::core
