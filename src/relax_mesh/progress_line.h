// For one who waits at a terminal.
#pragma once

#include <string>

namespace spherical_springs::relax_mesh {

/// A line on standard error that tells how far something has come, and goes when that is over.
/// Where standard error is no terminal there is none. For one thread at a time.
class ProgressLine {
 public:
  explicit ProgressLine(std::string what);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// @param fraction 0 to 1
  void show(double fraction);

 private:
  const std::string what_;
  const bool seen_;
  int shown_ = -1;  // [%]
};

}  // namespace spherical_springs::relax_mesh
