// Ctrl-C, for a program that has to end what it has asked of others.
#pragma once

#include <stdexcept>

namespace spherical_springs::relax_mesh {

struct Interrupted : std::runtime_error {
  Interrupted() : std::runtime_error("interrupted") {}
};

/// Keeps the first SIGINT or SIGTERM in mind from here on; a second one ends the program as usual.
/// ROS, if at all, is to be initialised with `NoSigintHandler`.
void keepInterruptions();

/// Whether there has been a signal.
bool interrupted();

/// @throw Interrupted after a signal.
void throwIfInterrupted();

}  // namespace spherical_springs::relax_mesh
