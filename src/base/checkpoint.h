#pragma once

#include <functional>

namespace spherical_springs::core {

/// Called by work that may take long, several times a second by every thread at work; what it
/// throws ends the work and comes out. It may be called by several threads at once.
using Checkpoint = std::function<void()>;

inline void passAll() {}

}  // namespace spherical_springs::core
