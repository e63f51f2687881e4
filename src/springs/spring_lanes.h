// The formula of each kind of spring in lanes: the forces, energies and dampers of the kernels are
// uses of it. src/springs/*.cpp has the same conditions one at a time, also where these are hard.
//
// `value` is the condition C, and `slopes` are -factor grad C at the ends, but for what is along
// their positions; they are 0 where the spring is hard, near a place without a derivative.
// `gradients` are p x grad C at all ends p but the last; they mean nothing where it is hard.
#pragma once

#include "base/lanes.h"

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kShortest = 1e-16;  // of a quarter of a squared chord, and of its supplement

/// Returns atan2(y, x).
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

/// The formula of `AngleSpring`.
struct AngleLanes {
  Lanes angle, sine;
  Lanes near, far;    ///< quarters of the squared chord and of its supplement's
  Lanes3 chord, sum;  ///< b - a and a + b
  Lanes3 beside;      ///< whose cross product with a is a x b and does not cancel
  LaneMask is_far;    ///< `beside` is a + b; elsewhere b - a
  LaneMask hard;

  [[gnu::always_inline]] AngleLanes(const Lanes3& a, const Lanes3& b) : chord(b - a), sum(a + b) {
    near = 0.25 * dot(chord, chord);
    far = 0.25 * dot(sum, sum);
    const LaneMask is_near = near < 0.25;
    is_far = far < 0.25;
    const Lanes cosine = far - near;
    const Lanes square = select(is_near, near, select(is_far, far, cosine * cosine));
    const Lanes root = select(is_near | is_far, squareRoot(square), cosine);
    const Lanes arcsine = root * arcsineRatio(square);
    angle = select(is_near, 2 * arcsine, select(is_far, kPi - 2 * arcsine, kPi / 2 - arcsine));
    sine = 2 * squareRoot(near * far);
    beside = select(is_far, sum, chord);
    hard = ~((near >= kShortest) & (far >= kShortest));
  }

  [[gnu::always_inline]] Lanes value(const Lanes& rest) const { return angle - rest; }

  [[gnu::always_inline]] void slopes(const Lanes& factor, Lanes3 (&at)[2]) const {
    at[0] = select0(~hard, factor / sine) * beside;
    at[1] = select(is_far, at[0], negative(at[0]));
  }

  [[gnu::always_inline]] void gradients(Lanes3 (&of)[1]) const {
    of[0] = 0.5 / sine * cross(chord, sum);
  }
};

struct TriangleEdges {
  Lanes3 ab, bc, ca;
  Lanes squared_ab, squared_bc, squared_ca;
  Lanes3 area;  ///< a x b + b x c + c x a
  Lanes triple_product, denominator;

  [[gnu::always_inline]] TriangleEdges(const Lanes3& a, const Lanes3& b, const Lanes3& c)
      : ab(b - a),
        bc(c - b),
        ca(a - c),
        squared_ab(dot(ab, ab)),
        squared_bc(dot(bc, bc)),
        squared_ca(dot(ca, ca)),
        area(cross(ca, ab)),
        triple_product(dot(a, area)),
        denominator(4 - 0.5 * (squared_ab + squared_bc + squared_ca)) {}

  /// Returns -factor times the gradient of the triple product at a corner p, but for what is along
  /// p: at a that is b x c, which is a x (c - b) + area.
  [[gnu::always_inline]] Lanes3 tripleProductSlope(const Lanes& factor, const Lanes3& p,
                                                   const Lanes3& opposite) const {
    return negative(factor * (cross(p, opposite) + area));
  }
};

/// Turns slopes at the first two corners into gradients: p x grad C = slope x p.
template <class Formula>
[[gnu::always_inline]] inline void gradientsBy(const Formula& formula, Lanes3 (&of)[2]) {
  Lanes3 slopes[3];
  formula.slopes(Lanes{} + 1, slopes);
  of[0] = cross(slopes[0], formula.a);
  of[1] = cross(slopes[1], formula.b);
}

/// The formula of `SolidAngleSpring` (Oosterom and Strackee 1983).
struct SolidAngleLanes {
  Lanes3 a, b, c;
  TriangleEdges e;
  Lanes squared_norm;
  LaneMask hard;  ///< two corners are nearly antipodal

  [[gnu::always_inline]] SolidAngleLanes(const Lanes3& first, const Lanes3& second,
                                         const Lanes3& third)
      : a(first), b(second), c(third), e(a, b, c) {
    constexpr double kAntipodal = 0.25;
    squared_norm = e.triple_product * e.triple_product + e.denominator * e.denominator;
    hard = ~(squared_norm >= kAntipodal);
  }

  /// Returns the difference from the area at rest, modulo 4 pi.
  [[gnu::always_inline]] Lanes value(const Lanes& rest) const {
    Lanes difference = 2 * arctangent(e.triple_product, e.denominator) - rest;
    difference -= select0(difference > 2 * kPi, 4 * kPi - Lanes{});
    difference += select0(difference < -2 * kPi, 4 * kPi - Lanes{});
    return difference;
  }

  /// At a the gradient is beta (b x c) - alpha (b + c), but for what is along a.
  [[gnu::always_inline]] void slopes(const Lanes& factor, Lanes3 (&at)[3]) const {
    const Lanes pull = select0(~hard, 2 * factor / squared_norm);
    const Lanes alpha = pull * e.triple_product, beta = pull * e.denominator;
    at[0] = alpha * (e.ab - e.ca) + e.tripleProductSlope(beta, a, e.bc);
    at[1] = alpha * (e.bc - e.ab) + e.tripleProductSlope(beta, b, e.ca);
    at[2] = alpha * (e.ca - e.bc) + e.tripleProductSlope(beta, c, e.ab);
  }

  [[gnu::always_inline]] void gradients(Lanes3 (&of)[2]) const { gradientsBy(*this, of); }
};

/// The odd step from -1 to 1 over [-1, 1], and its slope.
struct SignLanes {
  Lanes value, slope;

  [[gnu::always_inline]] explicit SignLanes(const Lanes& x) {
    const Lanes u = select(x < -1, Lanes{} - 1, select(x > 1, Lanes{} + 1, x));
    const Lanes square = u * u, rest = 1 - square;
    value = 0.125 * u * (15 - square * (10 - 3 * square));
    slope = 1.875 * rest * rest;
  }
};

/// The formula of `OrientedAngleSpring`.
struct OrientedAngleLanes {
  Lanes3 a, b, c;
  TriangleEdges e;
  Lanes width;
  AngleLanes between;
  SignLanes sign;
  LaneMask is_sharp;  ///< the change of sign
  LaneMask hard;

  [[gnu::always_inline]] OrientedAngleLanes(const Lanes3& first, const Lanes3& second,
                                            const Lanes3& third, const Lanes& width_in_use)
      : a(first),
        b(second),
        c(third),
        e(a, b, c),
        width(width_in_use),
        between(a, b),
        sign(e.triple_product / width),
        is_sharp(width <= 0),
        hard(between.hard | is_sharp) {}

  [[gnu::always_inline]] Lanes value(const Lanes& rest) const {
    return sign.value * between.angle - rest;
  }

  [[gnu::always_inline]] void slopes(const Lanes& factor, Lanes3 (&at)[3]) const {
    const Lanes3 along = select0(~hard, factor * sign.value / between.sine) * between.beside;
    const Lanes across = select0(~hard, factor * sign.slope * between.angle / width);
    at[0] = along + e.tripleProductSlope(across, a, e.bc);
    at[1] = select(between.is_far, along, negative(along)) + e.tripleProductSlope(across, b, e.ca);
    at[2] = e.tripleProductSlope(across, c, e.ab);
  }

  [[gnu::always_inline]] void gradients(Lanes3 (&of)[2]) const { gradientsBy(*this, of); }
};

}  // namespace
