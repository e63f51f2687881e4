// In which order a minimisation has the particles, and which of them meet.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "linear/graph.h"
#include "spherical_springs/system.h"

namespace spherical_springs::core {

/// Free particles along a curve, so that those that are joined are close, and those that are held
/// after them.
struct ParticleOrder {
  std::vector<std::uint32_t> particles;  ///< of each number
  std::vector<std::uint32_t> numbers;    ///< of each particle
  std::size_t free_count;
};

/// `free`: one flag a particle, whether it may move.
ParticleOrder particleOrder(const std::vector<bool>& free, const Points& positions);

/// Which free particles, by number, springs join; each with itself.
Graph freeGraph(const System& system, const ParticleOrder& order, int threads);

}  // namespace spherical_springs::core
