#include "geometry/curve_order.h"

#include <algorithm>
#include <tuple>

namespace spherical_springs::core {
namespace {

constexpr int kBits = 21;  // of each coordinate

/// The lowest 21 bits with two zeros between each and the next.
std::uint64_t spread(std::uint64_t bits) {
  bits = (bits | bits << 32) & 0x001f00000000ffff;
  bits = (bits | bits << 16) & 0x001f0000ff0000ff;
  bits = (bits | bits << 8) & 0x100f00f00f00f00f;
  bits = (bits | bits << 4) & 0x10c30c30c30c30c3;
  return (bits | bits << 2) & 0x1249249249249249;
}

/// Place along the curve of G. M. Morton, 1966.
std::uint64_t mortonCode(const Vector3& p) {
  std::uint64_t code = 0;
  for (int k = 0; k < 3; ++k) {
    const double cell = (p[k] + 1) * (1 << (kBits - 1));
    code |= spread(static_cast<std::uint64_t>(std::clamp(cell, 0., (1 << kBits) - 1.))) << k;
  }
  return code;
}

}  // namespace

std::vector<std::uint32_t> curveOrder(const Points& points) {
  struct Key {
    std::uint64_t code;
    std::uint32_t index;
  };
  std::vector<Key> keys(points.cols());
  for (std::uint32_t i = 0; i < keys.size(); ++i) keys[i] = {mortonCode(points.col(i)), i};
  const auto tie = [&](const Key& key) {
    const auto p = points.col(key.index);
    return std::make_tuple(p.x(), p.y(), p.z(), key.index);
  };
  std::sort(keys.begin(), keys.end(), [&](const Key& a, const Key& b) {
    return a.code != b.code ? a.code < b.code : tie(a) < tie(b);
  });
  std::vector<std::uint32_t> order(keys.size());
  std::transform(keys.begin(), keys.end(), order.begin(), [](const Key& k) { return k.index; });
  return order;
}

}  // namespace spherical_springs::core
