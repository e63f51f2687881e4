#include "spherical_springs/range.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

namespace spherical_springs::core {
namespace {

/// Not within a character of UTF-8, which has four bytes at most.
std::size_t endOfShown(const std::string& text) {
  constexpr std::size_t kLongest = 100, kBytes = 4;
  std::size_t end = std::min(text.size(), kLongest);
  while (end < text.size() && end > kLongest - kBytes && (text[end] & 0xC0) == 0x80) --end;
  return end;
}

}  // namespace

std::string toText(double value) {
  if (std::isnan(value)) return "nan";  // whose sign means nothing
  char text[32];
  for (int digits = 1; digits <= 17; ++digits) {
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    if (std::strtod(text, nullptr) == value) break;
  }
  return text;
}

std::string onOneLine(std::string text) {
  for (char& c : text) {
    if (std::iscntrl(static_cast<unsigned char>(c))) c = '?';
  }
  return text;
}

std::string shortened(const std::string& text) {
  const std::size_t end = endOfShown(text);
  const std::string shown = onOneLine(text.substr(0, end));
  return end < text.size() ? shown + "..." : shown;
}

std::string quoted(const std::string& text) {
  const std::string shown = "'" + shortened(text) + "'";
  return endOfShown(text) < text.size() ? shown + " (" + std::to_string(text.size()) + " bytes)"
                                        : shown;
}

void requireInside(const Range& range, double value, const char* field) {
  if (range.contains(value)) return;
  const std::string fault =
      std::string(field) + " is " + toText(value) + "; allowed: " + range.allowed;
  if (!std::isfinite(value)) throw NonFinite(fault);
  throw std::invalid_argument(fault);
}

}  // namespace spherical_springs::core
