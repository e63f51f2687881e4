// Ctrl-C, for a program that has to end what it has asked of others.
#pragma once

namespace spherical_springs::relax_mesh {

/// From here on SIGINT and SIGTERM are kept in mind, once: the next one ends the program as usual.
/// To be called after `ros::init` with `NoSigintHandler`.
void keepInterruptions();

/// Whether there has been one.
bool interrupted();

/// @throw std::runtime_error after one.
void throwIfInterrupted();

}  // namespace spherical_springs::relax_mesh
