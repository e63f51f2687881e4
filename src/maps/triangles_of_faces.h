// Triangles of faces, and what they cost, several at a time. For kernels alone.
#pragma once

#include "maps/face_cost.h"
#include "maps/face_kernels.h"
#include "springs/triangle_lanes.h"

namespace {

using namespace spherical_springs::mesh;

constexpr double kInfinity = __builtin_huge_val();

/// The constants of the faces that lanes work on.
struct LaneFaces {
  Lanes over_share, weight;
  LaneMask active;  ///< the first lanes, as far as there are faces
  double shape;
  AreaCost cost;

  template <class Lists>
  LaneFaces(const Lists& lists, std::uint32_t first, std::uint32_t end)
      : over_share(load(lists.over_shares + first)),
        weight(load(lists.weights + first)),
        shape(lists.shape),
        cost(lists.cost) {
    for (int k = 0; k < kLanes; ++k) active[k] = first + k < end ? -1 : 0;
  }
};

/// The triangle of three points, and its area.
struct LaneTriangle {
  Lanes3 sides[3];          ///< opposite of each corner
  Lanes squared_chords[3];  ///< of the sides
  Lanes triple_product, denominator;
  Lanes tangent;  ///< of a quarter of the area
  Lanes area;
  LaneMask large;  ///< for which all this is not accurate

  LaneTriangle(const Lanes3& a, const Lanes3& b, const Lanes3& c) : sides{c - b, a - c, b - a} {
    constexpr double kLeastDenominator = 0.5, kLargestSquare = 0.25;
    for (int i = 0; i < 3; ++i) squared_chords[i] = dot(sides[i], sides[i]);
    const auto& [bc, ca, ab] = squared_chords;
    // The shorter sides meet opposite of the longest one.
    const LaneMask at_a = (bc > ca) & (bc > ab), at_b = ~at_a & (ca > ab);
    const auto chosen = [&](const Lanes3& of_a, const Lanes3& of_b, const Lanes3& of_c) {
      return select(at_a, of_a, select(at_b, of_b, of_c));
    };
    triple_product = dot(chosen(a, b, c), cross(chosen(sides[1], sides[2], sides[0]),
                                                chosen(sides[2], sides[0], sides[1])));
    denominator = 4 - 0.5 * (ab + bc + ca);
    tangent =
        triple_product /
        (denominator + squareRoot(denominator * denominator + triple_product * triple_product));
    const Lanes square = tangent * tangent;
    area = 4 * tangent * arctangentRatio(square);
    large = ~((denominator > kLeastDenominator) & (square < kLargestSquare));
  }

  /// Returns what `surelyPositive` in coverage.h does, without a root.
  LaneMask surelyPositive() const {
    constexpr double kSquaredRounding = 9e-30;
    return (triple_product > 0) & (triple_product * triple_product >
                                   kSquaredRounding * squared_chords[1] * squared_chords[2]);
  }

  /// 1 + cosine of the side opposite of a corner.
  Lanes sum(int i) const { return 2 - 0.5 * squared_chords[i]; }

  /// One over the product of the three sums, which is half of the sum of the squares of denominator
  /// and triple product.
  Lanes overSums() const { return 1 / (sum(0) * sum(1) * sum(2)); }
  Lanes overSum(int i, const Lanes& over_sums) const {
    return sum((i + 1) % 3) * sum((i + 2) % 3) * over_sums;
  }
};

/// Returns the cost of the area and of the half sphere, times the weight of each face.
inline Cost<Lanes> areaCost(const LaneFaces& faces, const LaneTriangle& t) {
  Cost<Lanes> cost = faces.cost == AreaCost::square ? squareCost(t.area, faces.over_share)
                                                    : barrierCost(t.area, faces.over_share);
  if (faces.shape > 0) {
    const Cost<Lanes> half_sphere = halfSphereCost(t.tangent);
    const Lanes scale = faces.shape * faces.over_share;
    cost.value += scale * half_sphere.value;
    cost.slope += scale * half_sphere.slope;
    cost.bend += scale * half_sphere.bend;
  }
  return {faces.weight * cost.value, faces.weight * cost.slope, faces.weight * cost.bend};
}

inline Lanes edgeScale(const LaneFaces& faces) {
  return faces.shape * faces.weight * faces.over_share;
}

/// Returns the cost of the side opposite of a corner, times `scale`.
inline Cost<Lanes> sideCost(const LaneTriangle& t, int i, const Lanes& over_sums,
                            const Lanes& scale) {
  const Cost<Lanes> cost = edgeCost(t.squared_chords[i], t.overSum(i, over_sums));
  return {scale * cost.value, scale * cost.slope, scale * cost.bend};
}

inline void leaveOut(const LaneMask& mask, std::uint32_t first, LeftOut& left_out) {
  if (!any(mask)) return;
  for (int k = 0; k < kLanes; ++k) {
    if (mask[k]) left_out.faces[left_out.count++] = first + k;
  }
}

/// Fills `rows` with one corner of the faces from `first` on; lanes left over get the last face.
inline void cornerRows(const FaceLists& faces, int corner, std::uint32_t first, std::uint32_t end,
                       std::uint32_t (&rows)[kLanes]) {
  for (std::uint32_t k = 0; k < kLanes; ++k) {
    const std::uint32_t face = first + k < end ? first + k : end - 1;
    rows[k] = static_cast<std::uint32_t>(faces.corners[3 * face + corner]);
  }
}

inline Lanes3 gatherPoints(const PointRows& points, const std::uint32_t (&rows)[kLanes]) {
  Lanes3 result;
  Lanes after;
  gather(points.first, points.stride, rows, {&result.x, &result.y, &result.z, &after});
  return result;
}

inline LaneTriangle triangleOf(const FaceLists& faces, const PointRows& points, std::uint32_t first,
                               std::uint32_t end) {
  Lanes3 corners[3];
  for (int i = 0; i < 3; ++i) {
    std::uint32_t rows[kLanes];
    cornerRows(faces, i, first, end, rows);
    corners[i] = gatherPoints(points, rows);
  }
  return {corners[0], corners[1], corners[2]};
}

}  // namespace
