// The costs of a face by its area and by its edges, of one face or of several at a time.
#pragma once

namespace spherical_springs::mesh {

/// A function of one variable with its derivatives. `Real` is a number, or lanes of numbers.
/// Functions that return it are inlined, as this header is compiled for several instruction sets.
template <class Real>
struct Cost {
  Real value, slope, bend;
};

/// Returns (r + 1/r - 2) / 2 for r = area / share, with derivatives by the area.
template <class Real>
[[gnu::always_inline]] inline Cost<Real> barrierCost(const Real& area, const Real& over_share) {
  const Real r = area * over_share, error = r - 1, over = 1 / r;
  return {0.5 * error * error * over, 0.5 * error * (r + 1) * over * over * over_share,
          over * over * over * over_share * over_share};
}

/// Returns (r - 1)^2 / 2 for r = area / share, with derivatives by the area.
template <class Real>
[[gnu::always_inline]] inline Cost<Real> squareCost(const Real& area, const Real& over_share) {
  const Real error = area * over_share - 1;
  return {0.5 * error * error, error * over_share, over_share * over_share};
}

/// Returns tan^2(area / 4) with derivatives by the area, from `tangent` = tan(area / 4).
template <class Real>
[[gnu::always_inline]] inline Cost<Real> halfSphereCost(const Real& tangent) {
  const Real square = tangent * tangent;
  return {square, 0.5 * tangent * (1 + square), 0.125 * (1 + square) * (1 + 3 * square)};
}

/// Returns tan^2(edge / 2) / sqrt 3 with derivatives by the cosine of the edge, from its squared
/// chord and 1 / (1 + cosine).
template <class Real>
[[gnu::always_inline]] inline Cost<Real> edgeCost(const Real& squared_chord, const Real& over_sum) {
  constexpr double kScale = 0.57735026918962576;  // 1 / sqrt 3
  const Real square = over_sum * over_sum;
  return {0.5 * kScale * squared_chord * over_sum, -2 * kScale * square,
          4 * kScale * square * over_sum};
}

}  // namespace spherical_springs::mesh
