// How springs and particles lie in memory for kernels that take several at a time.
#pragma once

#include <cstddef>
#include <cstdint>

namespace spherical_springs::core {

inline constexpr std::size_t kGroup = 8;      ///< so many springs or particles lie side by side
inline constexpr std::size_t kRowLength = 4;  ///< of a vector in memory: x, y, z and one not used

/// [bytes]; lanes of AVX-512 that lie across two of them take longer to load.
inline constexpr std::size_t kCacheLine = 64;

struct alignas(kRowLength * sizeof(double)) Row {
  double values[kRowLength];
};

/// Particles side by side, a multiple of kGroup.
struct Particles {
  const double* positions;  ///< rows
  double* moved;            ///< rows; may be those of `positions`
  double* velocities[3];    ///< of each component, an array
  const double* forces;     ///< rows
  const double* inverse_masses;
  std::uint32_t count;
};

}  // namespace spherical_springs::core
