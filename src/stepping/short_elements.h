// Forces of arcs and triangles of less than half a radian or so.
#pragma once

#include "stepping/near_lanes.h"
#include "stepping/step_batch.h"

namespace {

constexpr double kShort = 1. / 16;       // of a squared chord, for the short way
constexpr double kSmallest = 1e-12;      // of the sum of a triangle's squared edges, likewise
constexpr double kSmall = 1.5 * kShort;  // so that no edge is longer than short

[[gnu::always_inline]] inline Lanes sineOf(const Lanes& squared_chord) {
  return squareRoot(squared_chord * (1 - 0.25 * squared_chord));
}

[[gnu::always_inline]] inline Lanes shortPull(const LaneConstants& spring,
                                              const Lanes& squared_chord, const Lanes& over_sine) {
  return spring.stiffness * (overSineRatio(0.25 * squared_chord) - spring.rest * over_sine);
}

/// Returns whether a short arc may be near the place where its ends meet.
[[gnu::always_inline]] inline LaneMask mayBeMeeting(const Lanes& squared_chord, const Lanes& rest) {
  using spherical_springs::core::kNearPairShare;
  static_assert(kShort < spherical_springs::core::kNearPair * spherical_springs::core::kNearPair);
  return squared_chord < kNearMargin * kNearPairShare * kNearPairShare * rest * rest;
}

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
    LaneMask is_other = isOther(e, LaneConstants(batch, 0).rest);
    if (kArcs > 0) is_other |= mayBeMeeting(e.squared_ab, LaneConstants(batch, 1).rest);
    if (kArcs > 1) is_other |= mayBeMeeting(e.squared_bc, LaneConstants(batch, 2).rest);
    if (any(is_other)) return false;
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
    constexpr double kLargestRest = 5;     // no such area is near half of 4 pi away from it
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

/// Forces of short arcs.
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
    const LaneMask is_other = (squared < 4 * kShortest) | (squared > kShort) |
                              mayBeMeeting(squared, LaneConstants(batch, 0).rest);
    if (any(is_other)) return false;
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

/// For elements that have no short way.
template <class OnlyGroup>
class NoShortWay {
 public:
  using Group = OnlyGroup;
  NoShortWay(const double*, double*) {}
  bool add(const Batch<Group>&) { return false; }
  void flush() {}
};

}  // namespace
