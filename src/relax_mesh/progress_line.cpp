#include "relax_mesh/progress_line.h"

#include <unistd.h>

#include <cmath>
#include <iostream>
#include <utility>

namespace spherical_springs::relax_mesh {
namespace {

constexpr auto kWiped = "\r\033[K";  // ECMA-48: back to the first column, erase in line

}  // namespace

ProgressLine::ProgressLine(std::string what)
    : what_(std::move(what)), seen_(isatty(STDERR_FILENO) != 0) {}

ProgressLine::~ProgressLine() {
  if (shown_ >= 0) std::cerr << kWiped << std::flush;
}

void ProgressLine::show(double fraction) {
  const int percent = static_cast<int>(std::lround(100 * fraction));
  if (!seen_ || percent == shown_) return;
  shown_ = percent;
  std::cerr << kWiped << what_ << " ... " << percent << " %" << std::flush;
}

}  // namespace spherical_springs::relax_mesh
