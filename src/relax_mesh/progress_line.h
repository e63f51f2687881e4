// For one who waits.
#pragma once

#include <chrono>

#include "spherical_springs/maps/sphere_map.h"

namespace spherical_springs::relax_mesh {

/// Tells on standard error how far a map has come: on a terminal by a line that changes, and goes
/// when that is over, elsewhere by a line every few seconds. For one thread at a time.
class ProgressLine {
 public:
  ProgressLine();
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(const mesh::MapProgress& progress);

 private:
  using Clock = std::chrono::steady_clock;

  const bool on_terminal_;
  bool shown_ = false;
  Clock::time_point next_;
};

}  // namespace spherical_springs::relax_mesh
