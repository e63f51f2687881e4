#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>

#include "spherical_springs/range.h"

namespace spherical_springs::core {

/// Rounds to two significant digits.
inline double rounded(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1e", number);
  return std::strtod(text, nullptr);
}

inline std::string roundedText(double number) { return toText(rounded(number)); }

}  // namespace spherical_springs::core
