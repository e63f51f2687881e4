// Groups of particles that springs join.
#pragma once

#include <cstdint>
#include <vector>

#include "spherical_springs/system.h"

namespace spherical_springs::core {

/// Whether particles that the same pinned one joins are in one group.
enum class Pins { join, part };

/// Returns the number of each particle's group, from 0: those that springs join, directly or by
/// others. Where pins part groups, each pinned particle is a group of its own.
std::vector<std::uint32_t> groupsOf(const System& system, Pins pins);

}  // namespace spherical_springs::core
