// The choice of method and time step for an accuracy.
#pragma once

#include <memory>
#include <string>

#include "spherical_springs/simulation.h"

namespace spherical_springs::core {

/// Returns the steps with which a state is to be stepped on as `wish` asks. Depends on the
/// arguments alone, and gives equal bits for any number of threads.
/// @throw std::bad_alloc.
StepChoice chooseSteps(const std::shared_ptr<const Plan>& plan, const StepWish& wish,
                       const State& state);

/// Returns `present` where it still does, and else a new choice. Steps that are somewhat more or
/// less exact than asked for are kept, as a symplectic method loses by every change of its step.
/// @throw std::bad_alloc.
StepChoice reviewedSteps(const std::shared_ptr<const Plan>& plan, const StepWish& wish,
                         const State& state, const StepChoice& present);

/// Says in words how steps are done for an accuracy [rad/s].
std::string inWords(const StepChoice& choice, double accuracy);

}  // namespace spherical_springs::core
