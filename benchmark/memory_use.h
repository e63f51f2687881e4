// Peak memory of a piece of work, in a process of its own.
#pragma once

#include <cstddef>
#include <functional>

namespace benchmark_scenes {

/// Bytes resident beyond those at the start.
struct MemoryUse {
  std::size_t prepared = 0;  ///< when the work is about to begin
  std::size_t peak = 0;      ///< while it is done
};

/// Calls `prepare`, then the work that it returns. To be called before this process makes any
/// threads, which the other would not have.
/// @throw std::runtime_error where the system keeps no account of peak memory.
MemoryUse memoryUse(const std::function<std::function<void()>()>& prepare);

}  // namespace benchmark_scenes
