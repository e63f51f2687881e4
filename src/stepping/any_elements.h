// Forces of arcs, triangles and oriented arcs of any size, but for the hard ones.
#pragma once

#include "stepping/step_batch.h"

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kAntipodal = 0.25;  // of the squared norm of a triangle

/// atan2(y, x)
[[gnu::always_inline]] inline Lanes arctangent(const Lanes& y, const Lanes& x) {
  constexpr double kTangentOfEighth = 0.41421356237309503;  // of pi / 8
  const Lanes up = absolute(y), across = absolute(x);
  const LaneMask steep = up > across;
  const Lanes more = select(steep, up, across), less = select(steep, across, up);
  const LaneMask diagonal = less > kTangentOfEighth * more;
  const Lanes u = select(diagonal, less - more, less) / select(diagonal, less + more, more);
  Lanes angle = u * arctangentRatio(u * u) + select0(diagonal, kPi / 4 - Lanes{});
  angle = select(steep, kPi / 2 - angle, angle);
  angle = select(x < 0, kPi - angle, angle);
  return select(y < 0, -angle, angle);
}

struct AnyAngle {
  Lanes value, sine;
  Lanes3 beside;    ///< whose cross product with a is a x b and does not cancel
  LaneMask is_far;  ///< `beside` is a + b; elsewhere b - a
  LaneMask hard;
};

inline AnyAngle anyAngle(const Lanes3& a, const Lanes3& b) {
  const Lanes3 chord = b - a, sum = a + b;
  const Lanes near = 0.25 * dot(chord, chord), far = 0.25 * dot(sum, sum);
  const LaneMask is_near = near < 0.25, is_far = far < 0.25;
  const Lanes cosine = far - near;
  const Lanes square = select(is_near, near, select(is_far, far, cosine * cosine));
  const Lanes root = select(is_near | is_far, squareRoot(square), cosine);
  const Lanes arcsine = root * arcsineRatio(square);
  const Lanes angle =
      select(is_near, 2 * arcsine, select(is_far, kPi - 2 * arcsine, kPi / 2 - arcsine));
  return {angle, 2 * squareRoot(near * far), select(is_far, sum, chord), is_far,
          ~((near >= kShortest) & (far >= kShortest))};
}

/// The force on `a` is pull `beside`, that on `b` the same where it is far, elsewhere the opposite.
struct AnyArc {
  Lanes pull;  ///< 0 where it is hard
  Lanes3 beside;
  LaneMask is_far, hard;
};

inline AnyArc anyArc(const Lanes3& a, const Lanes3& b, const LaneConstants& spring) {
  const AnyAngle angle = anyAngle(a, b);
  const Lanes pull = spring.stiffness * (angle.value - spring.rest) / angle.sine;
  return {select0(~angle.hard, pull), angle.beside, angle.is_far, angle.hard};
}

/// Whether two corners of a triangle are nearly antipodal, by its squared norm.
[[gnu::always_inline]] inline LaneMask isNearlyAntipodal(const Lanes& squared_norm) {
  return ~(squared_norm >= kAntipodal);
}

/// Difference between the solid angle of a triangle and the one at rest, modulo 4 pi.
[[gnu::always_inline]] inline Lanes areaDifference(const Lanes& triple_product,
                                                   const Lanes& denominator, const Lanes& rest) {
  Lanes difference = 2 * arctangent(triple_product, denominator) - rest;
  difference -= select0(difference > 2 * kPi, 4 * kPi - Lanes{});
  difference += select0(difference < -2 * kPi, 4 * kPi - Lanes{});
  return difference;
}

/// Factors of a triangle's forces: 2 stiffness C / squared norm, times denominator and triple
/// product.
struct AnyTriangle {
  Lanes beta, alpha;  ///< 0 where it is hard
  LaneMask hard;
};

inline AnyTriangle anyTriangle(const Lanes& triple_product, const Lanes& denominator,
                               const LaneConstants& spring) {
  const Lanes squared_norm = triple_product * triple_product + denominator * denominator;
  const LaneMask hard = isNearlyAntipodal(squared_norm);
  const Lanes difference = areaDifference(triple_product, denominator, spring.rest);
  const Lanes pull = select0(~hard, 2 * spring.stiffness * difference / squared_norm);
  return {pull * denominator, pull * triple_product, hard};
}

inline void addArc(const AnyArc& arc, const LaneMask& hard, double* forces,
                   const std::uint32_t* rows_a, const std::uint32_t* rows_b) {
  const Lanes3 on_a = select0(~hard, arc.pull) * arc.beside;
  addRows(on_a, forces, rows_a);
  addRows(select(arc.is_far, on_a, negative(on_a)), forces, rows_b);
}

/// The force at a corner p that is -factor times the gradient of the triple product, but for what
/// is along p: at a that is b x c, which is a x (c - b) + area.
[[gnu::always_inline]] inline Lanes3 tripleProductForce(const Lanes& factor, const Lanes3& p,
                                                        const Lanes3& opposite,
                                                        const TriangleEdges& e) {
  return negative(factor * (cross(p, opposite) + e.area));
}

// At a the gradient is beta (b x c) - alpha (b + c), but for what is along a.
template <int kArcs>
LaneMask addAnyTriangles(const Batch<Triangles<kArcs>>& batch, const double* positions,
                         double* forces) {
  const Lanes3 a = batch.gather(0, positions), b = batch.gather(1, positions),
               c = batch.gather(2, positions);
  const TriangleEdges e(a, b, c);
  const AnyTriangle t = anyTriangle(e.triple_product, e.denominator, LaneConstants(batch, 0));
  LaneMask hard = t.hard;
  AnyArc first_arc = {}, second_arc = {};
  if (kArcs > 0) first_arc = anyArc(a, b, LaneConstants(batch, 1));
  if (kArcs > 1) second_arc = anyArc(b, c, LaneConstants(batch, 2));
  hard |= first_arc.hard | second_arc.hard;
  if (kArcs > 0) addArc(first_arc, hard, forces, batch.rows(0), batch.rows(1));
  if (kArcs > 1) addArc(second_arc, hard, forces, batch.rows(1), batch.rows(2));
  const Lanes alpha = select0(~hard, t.alpha), beta = select0(~hard, t.beta);
  addRows(alpha * (e.ab - e.ca) + tripleProductForce(beta, a, e.bc, e), forces, batch.rows(0));
  addRows(alpha * (e.bc - e.ab) + tripleProductForce(beta, b, e.ca, e), forces, batch.rows(1));
  addRows(alpha * (e.ca - e.bc) + tripleProductForce(beta, c, e.ab, e), forces, batch.rows(2));
  return hard;
}

template <int kSprings>
LaneMask addAny(const Batch<ElementGroup<3, kSprings>>& batch, const double* positions,
                double* forces) {
  return addAnyTriangles<kSprings - 1>(batch, positions, forces);
}

LaneMask addAny(const Batch<Arcs>& batch, const double* positions, double* forces) {
  const AnyArc arc =
      anyArc(batch.gather(0, positions), batch.gather(1, positions), LaneConstants(batch, 0));
  addArc(arc, arc.hard, forces, batch.rows(0), batch.rows(1));
  return arc.hard;
}

/// The odd step from -1 to 1 over [-1, 1], and its slope.
struct LaneSign {
  Lanes value, slope;
};

inline LaneSign signOf(const Lanes& x) {
  const Lanes u = select(x < -1, Lanes{} - 1, select(x > 1, Lanes{} + 1, x));
  const Lanes square = u * u, rest = 1 - square;
  return {0.125 * u * (15 - square * (10 - 3 * square)), 1.875 * rest * rest};
}

LaneMask addAny(const Batch<OrientedArcs>& batch, const double* positions, double* forces) {
  const Lanes3 a = batch.gather(0, positions), b = batch.gather(1, positions),
               c = batch.gather(2, positions);
  const TriangleEdges e(a, b, c);
  const Lanes rest = load(batch.group->rest + batch.first);
  const Lanes stiffness = load(batch.group->stiffness + batch.first);
  const Lanes width = load(batch.group->width + batch.first);
  const AnyAngle angle = anyAngle(a, b);
  const LaneMask hard = angle.hard | (width <= 0);
  const LaneSign sign = signOf(e.triple_product / width);
  const Lanes pull = stiffness * (sign.value * angle.value - rest);
  const Lanes along = select0(~hard, pull * sign.value / angle.sine);
  const Lanes across = select0(~hard, pull * sign.slope * angle.value / width);

  const Lanes3 on_a = along * angle.beside;
  const Lanes3 on_b = select(angle.is_far, on_a, negative(on_a));
  addRows(on_a + tripleProductForce(across, a, e.bc, e), forces, batch.rows(0));
  addRows(on_b + tripleProductForce(across, b, e.ca, e), forces, batch.rows(1));
  addRows(tripleProductForce(across, c, e.ab, e), forces, batch.rows(2));
  return hard;
}

}  // namespace
