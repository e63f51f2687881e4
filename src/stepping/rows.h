// Vectors that lie in rows of four doubles, to lanes and back.
#pragma once

#include "base/lanes.h"
#include "stepping/step_kernels.h"

namespace {

using spherical_springs::core::kRowLength;

#ifdef __AVX__

/// `at(k)` is the row of lane k.
template <class RowAt>
[[gnu::always_inline]] inline Lanes3 lanesFromRows(const RowAt& at) {
  Lanes3 result = {};
  for (int part = 0; part < kLanes / 4; ++part) {
    Four rows[4];
    for (int k = 0; k < 4; ++k) rows[k] = at(4 * part + k);
    transpose(rows);
    setFour(rows[0], part, result.x);
    setFour(rows[1], part, result.y);
    setFour(rows[2], part, result.z);
  }
  return result;
}

/// Calls `use(k, row)` with the row of each lane k; its fourth number is 0.
template <class Use>
[[gnu::always_inline]] inline void forEachRow(const Lanes3& v, const Use& use) {
  for (int part = 0; part < kLanes / 4; ++part) {
    Four rows[4] = {fourOf(v.x, part), fourOf(v.y, part), fourOf(v.z, part), Four{}};
    transpose(rows);
    for (int k = 0; k < 4; ++k) use(4 * part + k, rows[k]);
  }
}

#else  // registers do not hold a row

template <class RowAt>
[[gnu::always_inline]] inline Lanes3 lanesFromRows(const RowAt& at) {
  Lanes3 result = {};
  for (int k = 0; k < kLanes; ++k) {
    const Four row = at(k);
    result.x[k] = row[0];
    result.y[k] = row[1];
    result.z[k] = row[2];
  }
  return result;
}

template <class Use>
[[gnu::always_inline]] inline void forEachRow(const Lanes3& v, const Use& use) {
  for (int k = 0; k < kLanes; ++k) use(k, Four{v.x[k], v.y[k], v.z[k], 0});
}

#endif

/// The rows at `offsets` [doubles].
[[gnu::always_inline]] inline Lanes3 gatherRows(const double* rows, const std::uint32_t* offsets) {
  return lanesFromRows([&](int k) { return loadFour(rows + offsets[k]); });
}

[[gnu::always_inline]] inline Lanes3 loadRows(const double* rows) {
  return lanesFromRows([&](int k) { return loadFour(rows + kRowLength * k); });
}

/// The differences of the rows at `offsets` from those at `base`.
[[gnu::always_inline]] inline Lanes3 gatherDifferences(const double* rows,
                                                       const std::uint32_t* offsets,
                                                       const std::uint32_t* base) {
  return lanesFromRows(
      [&](int k) { return loadFour(rows + offsets[k]) - loadFour(rows + base[k]); });
}

[[gnu::always_inline]] inline void addRows(const Lanes3& v, double* rows,
                                           const std::uint32_t* offsets) {
  forEachRow(v, [&](int k, const Four& row) { addFour(row, rows + offsets[k]); });
}

[[gnu::always_inline]] inline void storeRows(const Lanes3& v, double* rows) {
  forEachRow(v,
             [&](int k, const Four& row) { std::memcpy(rows + kRowLength * k, &row, sizeof row); });
}

}  // namespace
