#include "relax_mesh/progress_line.h"

#include <unistd.h>

#include <cmath>
#include <iostream>
#include <string>

#include "base/rounded.h"

namespace spherical_springs::relax_mesh {
namespace {

constexpr auto kWiped = "\r\033[K";  // ECMA-48: back to the first column, erase in line
constexpr std::chrono::milliseconds kOnTerminal(200), kElsewhere(3000);  // between looks

std::string wordsFor(const mesh::MapProgress& progress) {
  return "mapping ... " + std::to_string(std::lround(100 * progress.fraction)) +
         " % of the time, " +
         (std::isinf(progress.spread) ? "no map yet"
                                      : "spread " + core::roundedText(progress.spread));
}

}  // namespace

ProgressLine::ProgressLine()
    : on_terminal_(isatty(STDERR_FILENO) != 0),
      next_(Clock::now() + (on_terminal_ ? kOnTerminal : kElsewhere)) {}

ProgressLine::~ProgressLine() {
  if (shown_ && on_terminal_) std::cerr << kWiped << std::flush;
}

void ProgressLine::show(const mesh::MapProgress& progress) {
  const auto now = Clock::now();
  if (now < next_) return;
  next_ = now + (on_terminal_ ? kOnTerminal : kElsewhere);
  shown_ = true;
  if (on_terminal_) {
    std::cerr << kWiped << wordsFor(progress) << std::flush;
  } else {
    std::cerr << wordsFor(progress) << std::endl;
  }
}

}  // namespace spherical_springs::relax_mesh
