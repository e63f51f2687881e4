#include "geometry/tessellation.h"

#include <cmath>

namespace spherical_springs::core {
namespace {

Vector3 midpoint(const Vector3& a, const Vector3& b) {
  const Arc whole = arc(a, b);
  return rotated(a, 0.5 * whole.angle * whole.axis);
}

/// Compares sides by their chords. `turns` bounds the depth, whatever the corners are.
void halve(const Vector3& a, const Vector3& b, const Vector3& c, double longest_chord, int turns,
           std::vector<Vector3>& corners) {
  const double ab = (a - b).norm();
  const double bc = (b - c).norm();
  const double ca = (c - a).norm();
  if (turns == 0 || (ab <= longest_chord && bc <= longest_chord && ca <= longest_chord)) {
    corners.insert(corners.end(), {a, b, c});
  } else if (ab >= bc && ab >= ca) {
    const Vector3 middle = midpoint(a, b);
    halve(a, middle, c, longest_chord, turns - 1, corners);
    halve(middle, b, c, longest_chord, turns - 1, corners);
  } else if (bc >= ca) {
    halve(b, c, a, longest_chord, turns - 1, corners);
  } else {
    halve(c, a, b, longest_chord, turns - 1, corners);
  }
}

}  // namespace

double pieceWithin(double depth) { return 2 * std::acos(1 - depth); }

void appendArc(const Vector3& a, const Vector3& b, double longest, std::vector<Vector3>& ends) {
  const Arc whole = arc(a, b);
  const int pieces = static_cast<int>(std::ceil(whole.angle / longest));
  for (int i = 0; i < pieces; ++i) {
    const auto at = [&](int end) {
      return end == pieces ? b : rotated(a, whole.angle * end / pieces * whole.axis);
    };
    ends.push_back(at(i));
    ends.push_back(at(i + 1));
  }
}

void appendTriangle(const Vector3& a, const Vector3& b, const Vector3& c, double longest,
                    std::vector<Vector3>& corners) {
  constexpr int kMostTurns = 60;
  halve(a, b, c, 2 * std::sin(longest / 2), kMostTurns, corners);
}

}  // namespace spherical_springs::core
