// The forces of step_kernels.h, for whatever level of instruction set a file that includes this is
// compiled for. The formulas are those of src/springs.
#pragma once

#include "lanes.h"
#include "rows.h"
#include "step_kernels.h"

namespace {

using spherical_springs::core::Arcs;
using spherical_springs::core::ElementGroup;
using spherical_springs::core::kGroup;
using spherical_springs::core::OrientedArcs;
using spherical_springs::core::Triangles;

constexpr double kPi = 3.14159265358979323846;

[[gnu::always_inline]] inline Lanes load(const double* values) {
  Lanes result;
  __builtin_memcpy(&result, values, sizeof(result));
  return result;
}

[[gnu::always_inline]] inline Lanes select(const LaneMask& mask, const Lanes& a, const Lanes& b) {
  return mask ? a : b;
}
[[gnu::always_inline]] inline Lanes larger(const Lanes& a, const Lanes& b) { return a > b ? a : b; }
[[gnu::always_inline]] inline Lanes absolute(const Lanes& x) { return select(x < 0, -x, x); }
[[gnu::always_inline]] inline Lanes select0(const LaneMask& mask, const Lanes& a) {
  return mask ? a : Lanes{};
}
[[gnu::always_inline]] inline Lanes3 select(const LaneMask& mask, const Lanes3& a,
                                            const Lanes3& b) {
  return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z)};
}

/// Horner's scheme for even and odd powers apart, which halves the wait.
template <std::size_t N>
[[gnu::always_inline]] inline Lanes polynomialByParity(const double (&coefficients)[N],
                                                       const Lanes& x) {
  constexpr std::size_t kLastEven = (N - 1) & ~std::size_t(1), kLastOdd = (N - 2) | 1;
  const Lanes square = x * x;
  Lanes even = coefficients[kLastEven] - Lanes{}, odd = coefficients[kLastOdd] - Lanes{};
  for (std::size_t i = kLastEven; i >= 2; i -= 2) even = coefficients[i - 2] + square * even;
  for (std::size_t i = kLastOdd; i >= 3; i -= 2) odd = coefficients[i - 2] + square * odd;
  return even + x * odd;
}

/// theta / sin(theta) for sin^2(theta / 2) up to 1/64, to 2e-17; a Chebyshev interpolant.
[[gnu::always_inline]] inline Lanes overSineRatio(const Lanes& h) {
  constexpr double kCoefficients[] = {1.0,
                                      0.6666666666666083,
                                      0.5333333333930259,
                                      0.45714283425600294,
                                      0.40635338010299754,
                                      0.3690184998994978,
                                      0.35895485532882426};
  return polynomialByParity(kCoefficients, h);
}

/// atan(u) / u for squares of u up to 2e-4, to 4e-18; a Chebyshev interpolant.
[[gnu::always_inline]] inline Lanes smallArctangentRatio(const Lanes& square) {
  constexpr double kCoefficients[] = {1.0, -0.33333333333303766, 0.19999999327995524,
                                      -0.14280826606559252};
  return polynomial(kCoefficients, square);
}

constexpr double kShortest = 1e-16;      // of a quarter of a squared chord, and of its supplement
constexpr double kAntipodal = 0.25;      // of the squared norm of a triangle
constexpr double kShort = 1. / 16;       // of a squared chord, for the short way
constexpr double kSmallest = 1e-12;      // of the sum of a triangle's squared edges, likewise
constexpr double kSmall = 1.5 * kShort;  // so that no edge is longer than short

/// Some elements of a group, one in each lane.
template <class Group>
struct Batch {
  const Group* group;
  std::size_t first;  ///< in the group

  [[gnu::always_inline]] const std::uint32_t* rows(int end) const {
    return group->ends[end] + first;
  }
  [[gnu::always_inline]] Lanes3 gather(int end, const double* positions) const {
    return gatherRows(positions, rows(end));
  }
};

/// Constants of the springs of a batch.
struct LaneConstants {
  Lanes rest, stiffness;

  template <class Group>
  [[gnu::always_inline]] LaneConstants(const Batch<Group>& batch, int spring)
      : rest(load(batch.group->springs[spring].rest + batch.first)),
        stiffness(load(batch.group->springs[spring].stiffness + batch.first)) {}
};

// --- arcs and triangles of less than half a radian or so ---

[[gnu::always_inline]] inline Lanes sineOf(const Lanes& squared_chord) {
  return squareRoot(squared_chord * (1 - 0.25 * squared_chord));
}

[[gnu::always_inline]] inline Lanes shortPull(const LaneConstants& spring,
                                              const Lanes& squared_chord, const Lanes& over_sine) {
  return spring.stiffness * (overSineRatio(0.25 * squared_chord) - spring.rest * over_sine);
}

// --- of any size ---

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

/// Factors of a triangle's forces: 2 stiffness C / squared norm, times denominator and triple
/// product.
struct AnyTriangle {
  Lanes beta, alpha;  ///< 0 where it is hard
  LaneMask hard;
};

inline AnyTriangle anyTriangle(const Lanes& triple_product, const Lanes& denominator,
                               const LaneConstants& spring) {
  const Lanes squared_norm = triple_product * triple_product + denominator * denominator;
  const LaneMask hard = ~(squared_norm >= kAntipodal);
  Lanes difference = 2 * arctangent(triple_product, denominator) - spring.rest;
  difference -= select0(difference > 2 * kPi, 4 * kPi - Lanes{});
  difference += select0(difference < -2 * kPi, 4 * kPi - Lanes{});
  const Lanes pull = select0(~hard, 2 * spring.stiffness * difference / squared_norm);
  return {pull * denominator, pull * triple_product, hard};
}

// --- both ---

struct TriangleEdges {
  Lanes3 ab, bc, ca;
  Lanes squared_ab, squared_bc, squared_ca;
  Lanes3 area;  ///< a x b + b x c + c x a
  Lanes triple_product, denominator;

  TriangleEdges(const Lanes3& a, const Lanes3& b, const Lanes3& c)
      : ab(b - a),
        bc(c - b),
        ca(a - c),
        squared_ab(dot(ab, ab)),
        squared_bc(dot(bc, bc)),
        squared_ca(dot(ca, ca)),
        area(cross(ca, ab)),
        triple_product(dot(a, area)),
        denominator(4 - 0.5 * (squared_ab + squared_bc + squared_ca)) {}
};

/// Copies member by member: as a whole the compiler would copy it in pieces of half a register,
/// and reading them back as whole ones stalls.
inline void put(const Lanes3& v, Lanes3& to) {
  to.x = v.x;
  to.y = v.y;
  to.z = v.z;
}

/// Triangles by the batch: first what they are, then how their edges pull, then the forces, so that
/// the processor has always enough to do that does not wait for anything.
///
/// With all three vertices on the unit sphere the solid angle is a function of the squared edges,
/// so its forces are along the edges, as those of arcs are. Its derivative by one of them has the
/// triple product below the line: slivers are left to `addAnyTriangles`.
template <int kArcs>
class ShortTriangles {
 public:
  using Group = Triangles<kArcs>;

  ShortTriangles(const double* positions, double* forces)
      : positions_(positions), forces_(forces) {}

  /// False where a triangle or arc is not short, or a triangle a sliver.
  [[gnu::always_inline]] bool add(const Batch<Group>& batch) {
    const TriangleEdges e(batch.gather(0, positions_), batch.gather(1, positions_),
                          batch.gather(2, positions_));
    batches_[count_] = batch;
    put(e.ab, ab_[count_]);
    put(e.bc, bc_[count_]);
    put(e.ca, ca_[count_]);
    squared_ab_[count_] = e.squared_ab;
    squared_bc_[count_] = e.squared_bc;
    squared_ca_[count_] = e.squared_ca;
    triple_product_[count_] = e.triple_product;
    if (any(isOther(e, LaneConstants(batch, 0).rest))) return false;
    if (++count_ == kMost) flush();
    return true;
  }

  void flush() {
    for (int i = 0; i < count_; ++i) computeInverses(i);
    for (int i = 0; i < count_; ++i) computePulls(i);
    for (int i = 0; i < count_; ++i) addForces(i);
    count_ = 0;
  }

 private:
  static constexpr int kMost = 8;

  [[gnu::always_inline]] static LaneMask isOther(const TriangleEdges& e, const Lanes& rest) {
    constexpr double kThinnest = 1. / 24;  // twice the area by the sum of the squared edges
    constexpr double kLargestRest = 5;     // no area below 1 is half of 4 pi away from it
    const Lanes sum = e.squared_ab + e.squared_bc + e.squared_ca;
    return (sum > kSmall) | (sum < kSmallest) | (absolute(e.triple_product) < kThinnest * sum) |
           (absolute(rest) > kLargestRest);
  }

  // One division for all.
  [[gnu::always_inline]] void computeInverses(int i) {
    const Lanes ab = squared_ab_[i], bc = squared_bc_[i], ca = squared_ca_[i];
    const Lanes alpha = triple_product_[i];
    const Lanes beta = 4 - 0.5 * (ab + bc + ca);
    const Lanes q = (alpha * beta) * (alpha * alpha + beta * beta);
    if constexpr (kArcs == 0) {
      over_q_[i] = 1 / q;
    } else if constexpr (kArcs == 1) {
      const Lanes sine = sineOf(ab);
      const Lanes over_all = 1 / (sine * q);
      over_q_[i] = over_all * sine;
      over_sine_ab_[i] = over_all * q;
    } else {
      const Lanes sine_ab = sineOf(ab), sine_bc = sineOf(bc);
      const Lanes sines = sine_ab * sine_bc;
      const Lanes over_all = 1 / (sines * q);
      over_q_[i] = over_all * sines;
      over_sine_ab_[i] = over_all * (q * sine_bc);
      over_sine_bc_[i] = over_all * (q * sine_ab);
    }
  }

  // d(solid angle) = 2 (beta d alpha - alpha d beta) / (alpha^2 + beta^2), beta = 4 - half the sum
  // of the squared edges, and alpha^2 is Gram's determinant.
  [[gnu::always_inline]] void computePulls(int i) {
    const Batch<Group>& batch = batches_[i];
    const LaneConstants spring(batch, 0);
    const Lanes ab = squared_ab_[i], bc = squared_bc_[i], ca = squared_ca_[i];
    const Lanes alpha = triple_product_[i], over_q = over_q_[i];
    const Lanes half_sum = 0.5 * (ab + bc + ca);
    const Lanes beta = 4 - half_sum;
    const Lanes alpha_alpha = alpha * alpha, beta_beta = beta * beta;
    const Lanes u = alpha_alpha * ((alpha_alpha + beta_beta) * over_q);  // alpha / beta
    const Lanes difference = 2 * u * smallArctangentRatio(u * u) - spring.rest;
    const Lanes pull = 2 * spring.stiffness * difference * over_q;
    const Lanes across = pull * beta_beta;  // 2 stiffness C beta / (alpha (alpha^2 + beta^2))
    const Lanes along = pull * (alpha_alpha * beta);
    Lanes along_ab = along, along_bc = along;
    if (kArcs > 0) along_ab += shortPull(LaneConstants(batch, 1), ab, over_sine_ab_[i]);
    if (kArcs > 1) along_bc += shortPull(LaneConstants(batch, 2), bc, over_sine_bc_[i]);
    const Lanes quarter_ab = 0.25 * ab, quarter_bc = 0.25 * bc;
    pull_ab_[i] = across * (half_sum - ab - quarter_bc * ca) + along_ab;
    pull_bc_[i] = across * (half_sum - bc - quarter_ab * ca) + along_bc;
    pull_ca_[i] = across * (half_sum - ca - quarter_ab * bc) + along;
  }

  [[gnu::always_inline]] void addForces(int i) {
    const Lanes3 ab = pull_ab_[i] * ab_[i], bc = pull_bc_[i] * bc_[i], ca = pull_ca_[i] * ca_[i];
    addRows(ab - ca, forces_, batches_[i].rows(0));
    addRows(bc - ab, forces_, batches_[i].rows(1));
    addRows(ca - bc, forces_, batches_[i].rows(2));
  }

  const double* const positions_;
  double* const forces_;
  int count_ = 0;
  Batch<Group> batches_[kMost];
  Lanes3 ab_[kMost], bc_[kMost], ca_[kMost];
  Lanes squared_ab_[kMost], squared_bc_[kMost], squared_ca_[kMost], triple_product_[kMost];
  Lanes over_q_[kMost], over_sine_ab_[kMost], over_sine_bc_[kMost];
  Lanes pull_ab_[kMost], pull_bc_[kMost], pull_ca_[kMost];
};

inline Lanes3 negative(const Lanes3& a) { return {-a.x, -a.y, -a.z}; }

inline void addArc(const AnyArc& arc, const LaneMask& hard, double* forces,
                   const std::uint32_t* rows_a, const std::uint32_t* rows_b) {
  const Lanes3 on_a = select0(~hard, arc.pull) * arc.beside;
  addRows(on_a, forces, rows_a);
  addRows(select(arc.is_far, on_a, negative(on_a)), forces, rows_b);
}

// At a the gradient is beta (b x c) - alpha (b + c), but for what is along a; and b x c is
// a x (c - b) + area.
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
  const Lanes3 area = beta * e.area;
  addRows(alpha * (e.ab - e.ca) - beta * cross(a, e.bc) - area, forces, batch.rows(0));
  addRows(alpha * (e.bc - e.ab) - beta * cross(b, e.ca) - area, forces, batch.rows(1));
  addRows(alpha * (e.ca - e.bc) - beta * cross(c, e.ab) - area, forces, batch.rows(2));
  return hard;
}

template <int kSprings>
LaneMask addAny(const Batch<ElementGroup<3, kSprings>>& batch, const double* positions,
                double* forces) {
  return addAnyTriangles<kSprings - 1>(batch, positions, forces);
}

/// The same for arcs alone.
class ShortArcs {
 public:
  using Group = Arcs;

  ShortArcs(const double* positions, double* forces) : positions_(positions), forces_(forces) {}

  [[gnu::always_inline]] bool add(const Batch<Arcs>& batch) {
    const Lanes3 chord = batch.gather(1, positions_) - batch.gather(0, positions_);
    const Lanes squared = dot(chord, chord);
    batches_[count_] = batch;
    put(chord, chord_[count_]);
    squared_[count_] = squared;
    if (any((squared < 4 * kShortest) | (squared > kShort))) return false;
    if (++count_ == kMost) flush();
    return true;
  }

  void flush() {
    for (int i = 0; i < count_; ++i) {
      pull_[i] = shortPull(LaneConstants(batches_[i], 0), squared_[i], 1 / sineOf(squared_[i]));
    }
    for (int i = 0; i < count_; ++i) {
      const Lanes3 force = pull_[i] * chord_[i];
      addRows(force, forces_, batches_[i].rows(0));
      addRows(negative(force), forces_, batches_[i].rows(1));
    }
    count_ = 0;
  }

 private:
  static constexpr int kMost = 8;

  const double* const positions_;
  double* const forces_;
  int count_ = 0;
  Batch<Arcs> batches_[kMost];
  Lanes3 chord_[kMost];
  Lanes squared_[kMost], pull_[kMost];
};

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

// The gradient of the triple product at a is b x c, which is a x (c - b) + area but for what is
// along a.
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
  const Lanes3 area = across * e.area;
  addRows(on_a - across * cross(a, e.bc) - area, forces, batch.rows(0));
  addRows(select(angle.is_far, on_a, negative(on_a)) - across * cross(b, e.ca) - area, forces,
          batch.rows(1));
  addRows(negative(across * cross(c, e.ab) + area), forces, batch.rows(2));
  return hard;
}

/// For elements that have no short way.
template <class OnlyGroup>
class NoShortWay {
 public:
  using Group = OnlyGroup;
  NoShortWay(const double*, double*) {}
  bool add(const Batch<Group>&) { return false; }
  void flush() {}
};

/// Brings a group nearer, if there is one; what is beyond the last does no harm.
template <class Group>
[[gnu::always_inline]] inline void fetch(const Group* group) {
  constexpr std::size_t kLine = 64;
  for (std::size_t at = 0; at < sizeof(Group); at += kLine) {
    __builtin_prefetch(reinterpret_cast<const char*>(group) + at);
  }
}

template <class Short>
std::uint32_t addAll(const typename Short::Group* groups, std::uint32_t group_count,
                     const double* positions, double* forces, std::uint32_t* hard) {
  constexpr std::uint32_t kAhead = 16;
  Short short_ones(positions, forces);
  std::uint32_t hard_count = 0;
  for (std::uint32_t g = 0; g < group_count; ++g) {
    fetch(groups + g + kAhead);
    for (std::uint32_t first = 0; first < kGroup; first += kLanes) {
      const Batch<typename Short::Group> batch = {groups + g, first};
      if (short_ones.add(batch)) continue;
      const LaneMask mask = addAny(batch, positions, forces);
      for (int k = 0; k < kLanes; ++k) {
        if (mask[k] != 0) hard[hard_count++] = g * kGroup + first + k;
      }
    }
  }
  short_ones.flush();
  return hard_count;
}

}  // namespace
