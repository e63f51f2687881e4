#include "spherical_springs/range.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

namespace spherical_springs::core {

std::string toText(double value) {
  if (std::isnan(value)) return "nan";  // whose sign means nothing
  char text[32];
  for (int digits = 1; digits <= 17; ++digits) {
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    if (std::strtod(text, nullptr) == value) break;
  }
  return text;
}

void requireInside(const Range& range, double value, const char* field) {
  if (range.contains(value)) return;
  const std::string fault =
      std::string(field) + " is " + toText(value) + "; allowed: " + range.allowed;
  if (!std::isfinite(value)) throw NonFinite(fault);
  throw std::invalid_argument(fault);
}

}  // namespace spherical_springs::core
