// The positive semidefinite part of symmetric matrices of six rows, several at a time.
#pragma once

#include "base/lanes.h"

namespace {

/// A symmetric matrix; its lower triangle counts.
struct LaneMatrix6 {
  Lanes entries[36];

  Lanes& at(int i, int j) { return entries[i > j ? 6 * i + j : 6 * j + i]; }
};

/// Returns the lanes in which a pivot of the Cholesky factorisation is not positive.
inline LaneMask indefinite(LaneMatrix6 m) {
  LaneMask result = {};
  for (int k = 0; k < 6; ++k) {
    result |= ~(m.at(k, k) > 0);
    const Lanes over = 1 / m.at(k, k);
    for (int i = k + 1; i < 6; ++i) {
      const Lanes factor = m.at(i, k) * over;
      for (int j = k + 1; j <= i; ++j) m.at(i, j) -= factor * m.at(j, k);
    }
  }
  return result;
}

struct LaneRotation {
  Lanes tangent, cosine, sine;
};

/// The rotation that makes the entry at p and q zero.
inline LaneRotation rotation(LaneMatrix6& m, int p, int q) {
  constexpr double kNotZero = 1e-300;
  const Lanes difference = m.at(q, q) - m.at(p, p), twice = 2 * m.at(p, q);
  const Lanes root = squareRoot(difference * difference + twice * twice) + kNotZero;
  const Lanes tangent = twice / (difference + select(difference < 0, -root, root));
  const Lanes cosine = 1 / squareRoot(1 + tangent * tangent);
  return {tangent, cosine, tangent * cosine};
}

inline void rotate(const LaneRotation& r, Lanes& p, Lanes& q) {
  const Lanes was = p;
  p = r.cosine * was - r.sine * q;
  q = r.sine * was + r.cosine * q;
}

inline void rotate(const LaneRotation& r, int p, int q, LaneMatrix6& m, Lanes (&vectors)[6][6]) {
  const Lanes turned = r.tangent * m.at(p, q);
  m.at(p, p) -= turned;
  m.at(q, q) += turned;
  m.at(p, q) = Lanes{};
  for (int k = 0; k < 6; ++k) {
    if (k != p && k != q) rotate(r, m.at(k, p), m.at(k, q));
    rotate(r, vectors[k][p], vectors[k][q]);
  }
}

/// Makes the matrices that are wanted diagonal by Jacobi's method, in rounds of three rotations of
/// different rows. `vectors` has the eigenvectors as columns.
inline void diagonalise(LaneMatrix6& m, Lanes (&vectors)[6][6], const LaneMask& wanted) {
  constexpr int kRounds[5][3][2] = {{{0, 1}, {2, 3}, {4, 5}},
                                    {{0, 2}, {1, 4}, {3, 5}},
                                    {{0, 3}, {1, 5}, {2, 4}},
                                    {{0, 4}, {1, 3}, {2, 5}},
                                    {{0, 5}, {1, 2}, {3, 4}}};
  constexpr int kMostSweeps = 12;
  constexpr double kSmall = 1e-28;  // of the squared norm
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) vectors[i][j] = Lanes{} + (i == j ? 1 : 0);
  }
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    Lanes inside = {}, outside = {};
    for (int i = 0; i < 6; ++i) {
      inside += m.at(i, i) * m.at(i, i);
      for (int j = 0; j < i; ++j) outside += m.at(i, j) * m.at(i, j);
    }
    if (!any((outside > kSmall * inside) & wanted)) return;
#pragma GCC unroll 5
    for (const auto& pairs : kRounds) {
      LaneRotation rotations[3];
      for (int i = 0; i < 3; ++i) rotations[i] = rotation(m, pairs[i][0], pairs[i][1]);
      for (int i = 0; i < 3; ++i) rotate(rotations[i], pairs[i][0], pairs[i][1], m, vectors);
    }
  }
}

/// Replaces each active matrix that has negative eigenvalues by the nearest one without.
inline void makeDefinite(LaneMatrix6& matrix, const LaneMask& active) {
  const LaneMask wanted = indefinite(matrix) & active;
  if (!any(wanted)) return;
  LaneMatrix6 diagonal = matrix;
  Lanes vectors[6][6];
  diagonalise(diagonal, vectors, wanted);
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j <= i; ++j) {
      Lanes sum = {};
      for (int k = 0; k < 6; ++k) {
        sum += larger(diagonal.at(k, k), Lanes{}) * vectors[i][k] * vectors[j][k];
      }
      matrix.at(i, j) = select(wanted, sum, matrix.at(i, j));
    }
  }
}

}  // namespace
