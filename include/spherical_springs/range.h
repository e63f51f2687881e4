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

/// Allowed values.
struct Range {
  double low;             ///< the least
  double high;            ///< the largest
  const char* allowed;    ///< the range in words, for messages
  bool open_low = false;  ///< whether `low` itself is not allowed

  /// Whether a value is allowed; no NaN is.
  bool contains(double value) const {
    return (open_low ? value > low : value >= low) && value <= high;
  }
};

/// The least magnitude of a stiffness or mass: products of a few such numbers are above 0.
inline constexpr double kSmallest = 1e-30;
/// The largest magnitude of a number of a scene: products of a few such numbers are finite.
inline constexpr double kLargest = 1e30;

/// Above any angular velocity [rad/s] that numbers within `kSmallest` and `kLargest` can bring
/// about.
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
