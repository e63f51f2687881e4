#include "curve_order.h"

#include <algorithm>

namespace spherical_springs::core {
namespace {

constexpr int kBits = 10;  // of each coordinate

/// The lowest ten bits with two zeros between each and the next.
std::uint32_t spread(std::uint32_t bits) {
  bits = (bits | bits << 16) & 0x030000ff;
  bits = (bits | bits << 8) & 0x0300f00f;
  bits = (bits | bits << 4) & 0x030c30c3;
  return (bits | bits << 2) & 0x09249249;
}

/// Place along the curve of G. M. Morton, 1966.
std::uint32_t mortonCode(const Vector3& p) {
  std::uint32_t code = 0;
  for (int k = 0; k < 3; ++k) {
    const double cell = (p[k] + 1) * (1 << (kBits - 1));
    code |= spread(static_cast<std::uint32_t>(std::clamp(cell, 0., (1 << kBits) - 1.))) << k;
  }
  return code;
}

}  // namespace

std::vector<std::uint32_t> curveOrder(const Points& points) {
  std::vector<std::uint64_t> keys(points.cols());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    keys[i] = std::uint64_t(mortonCode(points.col(i))) << 32 | i;
  }
  std::sort(keys.begin(), keys.end());
  return std::vector<std::uint32_t>(keys.begin(), keys.end());
}

}  // namespace spherical_springs::core
