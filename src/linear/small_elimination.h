// Elimination of few unknowns, without the copies by which libraries prepare for many.
#pragma once

#include "base/lanes.h"
#include "linear/elimination_kernels.h"

namespace {

using spherical_springs::core::FrontMatrix;

/// A part of a matrix by columns, `stride` numbers apart.
struct Columns {
  double* first;
  std::ptrdiff_t stride;

  double* at(std::ptrdiff_t row, std::ptrdiff_t column) const {
    return first + row + column * stride;
  }
  Columns from(std::ptrdiff_t row, std::ptrdiff_t column) const {
    return {at(row, column), stride};
  }
};

inline Lanes loadPart(const double* from, std::ptrdiff_t count) {
  Lanes result = {};
  std::memcpy(&result, from, static_cast<std::size_t>(count) * sizeof(double));
  return result;
}

enum class Target { read, zero };

/// Subtracts factors coefficients^T from a tile of `target`, or from zero, that is W columns wide
/// and V registers of rows high. With kIsPart only the first `part` lanes of the last register are
/// rows.
template <Target kTarget, int V, int W, bool kIsPart>
inline void subtractTile(const Columns& factors, const Columns& coefficients, std::ptrdiff_t depth,
                         const Columns& target, std::ptrdiff_t part) {
  Lanes sums[V][W] = {};
  for (int w = 0; w < W && kTarget == Target::read; ++w) {
    for (int v = 0; v < V; ++v) {
      const double* from = target.at(v * kLanes, w);
      sums[v][w] = kIsPart ? loadPart(from, part) : load(from);
    }
  }
  const auto subtract = [&](const Lanes(&x)[V], std::ptrdiff_t k) {
    for (int w = 0; w < W; ++w) {
      const double coefficient = *coefficients.at(w, k);
      for (int v = 0; v < V; ++v) sums[v][w] -= coefficient * x[v];
    }
  };
  // Lanes below the last row read on into the next columns, which the last `few` columns lack.
  const std::ptrdiff_t few = (kLanes - part + factors.stride - 1) / factors.stride;
  const std::ptrdiff_t whole = !kIsPart ? depth : depth > few ? depth - few : 0;
  for (std::ptrdiff_t k = 0; k < whole; ++k) {
    Lanes x[V];
    for (int v = 0; v < V; ++v) x[v] = load(factors.at(v * kLanes, k));
    subtract(x, k);
  }
  for (std::ptrdiff_t k = whole; k < depth; ++k) {
    Lanes x[V] = {loadPart(factors.at(0, k), part)};
    subtract(x, k);
  }
  for (int w = 0; w < W; ++w) {
    for (int v = 0; v < V; ++v) {
      const std::size_t count = kIsPart ? static_cast<std::size_t>(part) : kLanes;
      std::memcpy(target.at(v * kLanes, w), &sums[v][w], count * sizeof(double));
    }
  }
}

template <Target kTarget, int W>
inline void subtractColumns(const Columns& factors, const Columns& coefficients,
                            std::ptrdiff_t depth, const Columns& target, std::ptrdiff_t rows) {
  constexpr int kTall = 3;  // all that registers hold
  std::ptrdiff_t r = 0;
  for (; r + kTall * kLanes <= rows; r += kTall * kLanes) {
    subtractTile<kTarget, kTall, W, false>(factors.from(r, 0), coefficients, depth,
                                           target.from(r, 0), 0);
  }
  for (; r + kLanes <= rows; r += kLanes) {
    subtractTile<kTarget, 1, W, false>(factors.from(r, 0), coefficients, depth, target.from(r, 0),
                                       0);
  }
  if (r < rows) {
    subtractTile<kTarget, 1, W, true>(factors.from(r, 0), coefficients, depth, target.from(r, 0),
                                      rows - r);
  }
}

/// The Cholesky factor of W rows and columns.
template <int W>
inline bool factorise(const Columns& block) {
  for (int j = 0; j < W; ++j) {
    double pivot = *block.at(j, j);
    for (int k = 0; k < j; ++k) pivot -= *block.at(j, k) * *block.at(j, k);
    if (!(pivot > 0)) return false;
    const double root = __builtin_sqrt(pivot);
    *block.at(j, j) = root;
    for (int i = j + 1; i < W; ++i) {
      double sum = *block.at(i, j);
      for (int k = 0; k < j; ++k) sum -= *block.at(i, k) * *block.at(j, k);
      *block.at(i, j) = sum / root;
    }
  }
  return true;
}

/// Multiplies the rows of W columns by the inverse of the transposed factor.
template <int W>
inline void solveColumns(const Columns& factor, const Columns& target, std::ptrdiff_t rows) {
  double over[W];
  for (int j = 0; j < W; ++j) over[j] = 1 / *factor.at(j, j);
  for (std::ptrdiff_t r = 0; r < rows; r += kLanes) {
    const std::ptrdiff_t part = rows - r < kLanes ? rows - r : kLanes;
    Lanes solved[W];
    for (int j = 0; j < W; ++j) {
      Lanes x = part < kLanes ? loadPart(target.at(r, j), part) : load(target.at(r, j));
      for (int k = 0; k < j; ++k) x -= *factor.at(j, k) * solved[k];
      solved[j] = over[j] * x;
      std::memcpy(target.at(r, j), &solved[j], static_cast<std::size_t>(part) * sizeof(double));
    }
  }
}

/// Eliminates W unknowns from `j` on, those before them being eliminated.
template <int W>
inline bool eliminateColumns(const FrontMatrix& front, std::ptrdiff_t j) {
  const Columns own = {front.own, front.own_size}, below = {front.below, front.rest_size};
  const Columns rows = own.from(j, 0), block = own.from(j, j);
  subtractColumns<Target::read, W>(rows, rows, j, block, front.own_size - j);
  subtractColumns<Target::read, W>(below, rows, j, below.from(0, j), front.rest_size);
  if (!factorise<W>(block)) return false;
  solveColumns<W>(block, block.from(W, 0), front.own_size - j - W);
  solveColumns<W>(block, below.from(0, j), front.rest_size);
  return true;
}

bool eliminateSmall(const FrontMatrix& front) {
  constexpr std::ptrdiff_t kWide = 4;
  std::ptrdiff_t j = 0;
  for (; j + kWide <= front.own_size; j += kWide) {
    if (!eliminateColumns<kWide>(front, j)) return false;
  }
  for (; j < front.own_size; ++j) {
    if (!eliminateColumns<1>(front, j)) return false;
  }
  const Columns below = {front.below, front.rest_size}, rest = {front.rest, front.rest_size};
  for (j = 0; j + kWide <= front.rest_size; j += kWide) {
    subtractColumns<Target::zero, kWide>(below.from(j, 0), below.from(j, 0), front.own_size,
                                         rest.from(j, j), front.rest_size - j);
  }
  for (; j < front.rest_size; ++j) {
    subtractColumns<Target::zero, 1>(below.from(j, 0), below.from(j, 0), front.own_size,
                                     rest.from(j, j), front.rest_size - j);
  }
  return true;
}

}  // namespace
