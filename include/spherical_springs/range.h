// Ranges of allowed values, the one way in which a value outside is refused, and values in
// messages.
#pragma once

#include <stdexcept>
#include <string>

namespace spherical_springs::core {

/// A number that is not finite where a finite one is needed.
class NonFinite : public std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// Allowed values, from `low`, or above it where that end is open, to `high`.
struct Range {
  double low, high;
  const char* allowed;  ///< the range in words, for messages
  bool open_low = false;

  /// Whether a value is allowed; no NaN is.
  bool contains(double value) const {
    return (open_low ? value > low : value >= low) && value <= high;
  }
};

/// Magnitudes far beyond any scene and far within what products of a few of them can hold.
inline constexpr double kSmallest = 1e-30, kLargest = 1e30;

/// No angular velocity [rad/s] that such magnitudes can bring about is above this.
inline constexpr double kFastest = 1e100;

/// Shortest text that reads back as `value`, or "nan", "inf", "-inf".
std::string toText(double value);

/// Replaces control characters, ends of lines among them, by `?`.
std::string onOneLine(std::string text);

/// Text on one line; a long text is cut.
std::string shortened(const std::string& text);

/// Text for a message between quotes; a long text is cut, and its length told.
std::string quoted(const std::string& text);

/// @throw std::invalid_argument "`field` is `value`; allowed: ..." when `value` is outside; a
/// NonFinite when it is not finite.
void requireInside(const Range& range, double value, const char* field);

}  // namespace spherical_springs::core
