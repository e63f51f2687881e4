// The kernels of hessian_kernels.h, for whatever level of instruction set a file that includes this
// is compiled for. The formulas are those of src/springs, for solid angles that are not large.
#pragma once

#include "relaxation/hessian_kernels.h"
#include "springs/spring_lanes.h"
#include "springs/triangle_lanes.h"

namespace {

using spherical_springs::core::HessianArrays;
using spherical_springs::core::SpringFields;

/// The ends of kLanes springs from `first` on, and what belongs to them.
template <std::size_t N>
struct LaneSprings {
  std::uint32_t rows[N][kLanes];
  LaneFrame ends[N];
  Lanes rest, stiffness;

  LaneSprings(const SpringFields<N>& springs, std::uint32_t first, const HessianArrays& arrays) {
    for (int k = 0; k < kLanes; ++k) {
      for (std::size_t i = 0; i < N; ++i) rows[i][k] = springs.particles[first + k][i];
      rest[k] = springs.rest[first + k];
      stiffness[k] = springs.stiffness[first + k];
    }
    for (std::size_t i = 0; i < N; ++i) gather(arrays.places, rows[i], ends[i]);
  }
};

template <std::size_t N>
inline void addGradient(const std::uint32_t (&rows)[N][kLanes], std::size_t end,
                        const Lanes2& gradient, const HessianArrays& arrays) {
  for (int k = 0; k < kLanes; ++k) {
    const std::uint32_t row = rows[end][k];
    if (row >= arrays.free_count) continue;
    arrays.gradient[2 * row] += gradient.x[k];
    arrays.gradient[2 * row + 1] += gradient.y[k];
  }
}

/// Adds a block at the ends (i, j) of the springs from `first` on, and its transpose at (j, i).
template <std::size_t N>
inline void addBlock(const SpringFields<N>& springs, std::uint32_t first, std::size_t i,
                     std::size_t j, const LaneBlock& block, const HessianArrays& arrays) {
  for (int part = 0; part < kLanes / 4; ++part) {
    Four values[4] = {fourOf(block.xx, part), fourOf(block.yx, part), fourOf(block.xy, part),
                      fourOf(block.yy, part)};
    transpose(values);
    for (int k = 0; k < 4; ++k) {
      const auto& places = springs.places[first + 4 * part + k];
      const std::size_t place = places[N * i + j], opposite = places[N * j + i];
      if (place == HessianArrays::kNotStored) continue;
      addFour(values[k], arrays.hessian + 4 * place);
      if (i == j) continue;
      addFour(shuffled<0, 2, 1, 3>(values[k], values[k]), arrays.hessian + 4 * opposite);
    }
  }
}

inline void leaveOut(std::uint32_t begin, std::uint32_t end, std::uint32_t* left_out,
                     std::uint32_t& count) {
  for (std::uint32_t s = begin; s < end; ++s) left_out[count++] = s;
}

/// An arc between the ends of each spring.
struct Arcs {
  Lanes angle, half_sine, half_cosine;  ///< of the arc, and of half of it
  Lanes2 ga, gb;                        ///< gradients of the angle at both ends
};

/// Adds energies, gradients and Hessians of springs whose arcs are known.
inline void addArcs(const SpringFields<2>& springs, std::uint32_t first, const LaneSprings<2>& s,
                    const Arcs& arcs, const HessianArrays& arrays, Lanes& energy) {
  const Lanes r = arcs.angle - s.rest;
  const Lanes kr = s.stiffness * r;
  energy += 0.5 * kr * r;
  const Lanes2 &ga = arcs.ga, &gb = arcs.gb;
  addGradient(s.rows, 0, kr * ga, arrays);
  addGradient(s.rows, 1, kr * gb, arrays);

  // Both ends moving to the same side, and to opposite sides, across the arc.
  Lanes same = -kr * arcs.half_sine / arcs.half_cosine;
  Lanes opposite = kr * arcs.half_cosine / arcs.half_sine;
  const Lanes least = arrays.least_curvature * s.stiffness;
  same = same < least ? Lanes{} : same;
  opposite = opposite < least ? Lanes{} : opposite;
  const Lanes near = 0.5 * (same + opposite), across = 0.5 * (same - opposite);
  const Lanes2 ma = {ga.y, -ga.x}, mb = {-gb.y, gb.x};
  addBlock(springs, first, 0, 0, outer(s.stiffness * ga, ga) + outer(near * ma, ma), arrays);
  addBlock(springs, first, 1, 1, outer(s.stiffness * gb, gb) + outer(near * mb, mb), arrays);
  addBlock(springs, first, 0, 1, outer(s.stiffness * ga, gb) + outer(across * ma, mb), arrays);
}

/// Returns the arcs of springs whose ends are neither close nor nearly antipodal.
inline Arcs wideArcs(const LaneSprings<2>& s, const AngleLanes& angle) {
  const Lanes over_sine = 1 / angle.sine;
  const Lanes2 ga = -over_sine * s.ends[0].coordinates(angle.beside);
  const Lanes turned = select(angle.is_far, -over_sine, over_sine);
  return {angle.angle, squareRoot(angle.near), squareRoot(angle.far), ga,
          turned * s.ends[1].coordinates(angle.beside)};
}

/// Energy of the springs from `first` on, in each lane, added with the rest to `arrays`; false,
/// with nothing added, where ends are too close or too near to antipodal.
inline bool addAnyArcs(const SpringFields<2>& springs, std::uint32_t first,
                       const HessianArrays& arrays, Lanes& energy) {
  constexpr double kLongest = 0.25, kFarthest = 1 - 1e-12;  // of a quarter of the squared chord
  const LaneSprings<2> s(springs, first, arrays);
  const Lanes3 chord = s.ends[1].point - s.ends[0].point;
  const Lanes h = 0.25 * dot(chord, chord);  // the squared sine of half of the angle
  if (any((h < kShortest) | (h > kFarthest))) return false;
  if (any(h > kLongest)) {
    const AngleLanes angle(s.ends[0].point, s.ends[1].point);
    addArcs(springs, first, s, wideArcs(s, angle), arrays, energy);
    return true;
  }
  const Lanes half_sine = squareRoot(h);
  const Lanes half_cosine = squareRoot(1 - h);
  // A tangent vector has the same coordinates at b as its difference from a, and they do not
  // cancel.
  const Lanes over_sine = 1 / (2 * half_sine * half_cosine);
  const Lanes2 ga = -over_sine * s.ends[0].coordinates(chord);
  const Lanes2 gb = over_sine * s.ends[1].coordinates(chord);
  const Lanes angle = 2 * half_sine * arcsineRatio(h);
  addArcs(springs, first, s, {angle, half_sine, half_cosine, ga, gb}, arrays, energy);
  return true;
}

/// Adds energies, gradients and Hessians of triangles.
inline bool addTriangles(const SpringFields<3>& springs, std::uint32_t first,
                         const HessianArrays& arrays, Lanes& energy) {
  constexpr double kLeastDenominator = 0.5, kLargestSquare = 0.25;
  const LaneSprings<3> s(springs, first, arrays);
  const Lanes3 &a = s.ends[0].point, &b = s.ends[1].point, &c = s.ends[2].point;
  const Lanes3 ab = b - a, bc = c - b, ca = a - c;
  const Lanes triple_product = dot(a, cross(ca, ab));
  const Lanes denominator = 4 - 0.5 * (dot(ab, ab) + dot(bc, bc) + dot(ca, ca));
  if (any(denominator < kLeastDenominator)) return false;
  const Lanes u = triple_product / denominator;
  const Lanes square = u * u;
  if (any(square > kLargestSquare)) return false;
  const Lanes r = 2 * u * arctangentRatio(square) - s.rest;
  constexpr double kTurn = 2 * 3.14159265358979323846;
  if (any((r > kTurn) | (r < -kTurn))) return false;
  energy += 0.5 * s.stiffness * r * r;

  const Lanes over = 1 / (denominator * (1 + square));
  const Lanes beta = over, alpha = u * over;
  CornerSlope slopes[3];
  for (int i = 0; i < 3; ++i) {
    const Lanes3 &next = s.ends[(i + 1) % 3].point, &last = s.ends[(i + 2) % 3].point;
    slopes[i] = cornerSlope(s.ends[i], next, last, alpha, beta);
  }
  const Lanes pull = 2 * s.stiffness * r;
  for (int i = 0; i < 3; ++i) addGradient(s.rows, i, pull * slopes[i].v, arrays);

  const Lanes stiffness = 4 * s.stiffness, bend = arrays.definite ? Lanes{} : -pull;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    addBlock(springs, first, i, i, slopes[i].block(stiffness, bend), arrays);
    addBlock(springs, first, i, j,
             arrays.definite ? outer(stiffness * slopes[i].v, slopes[j].v)
                             : coupling(s.ends, slopes, i, stiffness, bend, alpha, beta),
             arrays);
  }
  return true;
}

/// Asks the memory for what springs from `begin` to `end` add to.
template <std::size_t N>
inline void fetchAhead(const SpringFields<N>& springs, std::uint32_t begin, std::uint32_t end,
                       const HessianArrays& arrays) {
  for (std::uint32_t s = begin; s < end; ++s) {
    for (const std::uint32_t place : springs.places[s]) {
      if (place == HessianArrays::kNotStored) continue;
      __builtin_prefetch(arrays.hessian + 4 * std::size_t{place}, 1);
    }
  }
}

template <std::size_t N,
          bool (*AddLanes)(const SpringFields<N>&, std::uint32_t, const HessianArrays&, Lanes&)>
double addAll(const SpringFields<N>& springs, std::uint32_t begin, std::uint32_t end,
              const HessianArrays& arrays, std::uint32_t* left_out, std::uint32_t& left_out_count) {
  Lanes energy = {};
  left_out_count = 0;
  for (; begin + kLanes <= end; begin += kLanes) {
    const std::uint32_t next = begin + kLanes;
    fetchAhead(springs, next, next + kLanes < end ? next + kLanes : end, arrays);
    if (!AddLanes(springs, begin, arrays, energy)) {
      leaveOut(begin, begin + kLanes, left_out, left_out_count);
    }
  }
  leaveOut(begin, end, left_out, left_out_count);
  return sum(energy);
}

}  // namespace

namespace spherical_springs::core {

/// This file's own.
static constexpr HessianKernels kKernels = {addAll<2, addAnyArcs>, addAll<3, addTriangles>};

}  // namespace spherical_springs::core
