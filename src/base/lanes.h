// Arithmetic on several numbers at a time. To be included once in each file that is compiled for a
// level of instruction set of its own; all is local to that file, so that no other may come to call
// what its processor cannot do.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#ifdef __AVX512F__
#include <immintrin.h>
#endif

#include "base/shuffled.h"

namespace {

using spherical_springs::core::shuffled;

#ifdef __AVX512F__
constexpr int kLanes = 8;
#else
constexpr int kLanes = 4;  // more would not stay in registers
#endif
using Lanes = double __attribute__((vector_size(kLanes * sizeof(double))));
using LaneMask = std::int64_t __attribute__((vector_size(kLanes * sizeof(double))));

using Four = double __attribute__((vector_size(4 * sizeof(double))));

inline Four loadFour(const double* from) {
  Four result;
  std::memcpy(&result, from, sizeof result);
  return result;
}

inline void addFour(const Four& value, double* to) {
  const Four sum = loadFour(to) + value;
  std::memcpy(to, &sum, sizeof sum);
}

#ifdef __AVX512F__

// Not by way of memory: a whole register waits for what was stored by halves. With masks of all
// numbers, as without them GCC 12 takes what is not used for not initialised.

/// Numbers 4 part to 4 part + 3.
[[gnu::always_inline]] inline Four fourOf(const Lanes& x, int part) {
  return part == 0 ? _mm512_maskz_extractf64x4_pd(0xff, x, 0)
                   : _mm512_maskz_extractf64x4_pd(0xff, x, 1);
}

[[gnu::always_inline]] inline void setFour(const Four& value, int part, Lanes& x) {
  x = part == 0 ? _mm512_mask_insertf64x4(x, 0xff, x, value, 0)
                : _mm512_mask_insertf64x4(x, 0xff, x, value, 1);
}

#else

inline Four fourOf(const Lanes& x, int part) {
  Four result;
  std::memcpy(&result, reinterpret_cast<const char*>(&x) + part * sizeof result, sizeof result);
  return result;
}

inline void setFour(const Four& value, int part, Lanes& x) {
  std::memcpy(reinterpret_cast<char*>(&x) + part * sizeof value, &value, sizeof value);
}

#endif

/// Rows become columns.
inline void transpose(Four (&rows)[4]) {
  const Four a = shuffled<0, 4, 2, 6>(rows[0], rows[1]);
  const Four b = shuffled<1, 5, 3, 7>(rows[0], rows[1]);
  const Four c = shuffled<0, 4, 2, 6>(rows[2], rows[3]);
  const Four d = shuffled<1, 5, 3, 7>(rows[2], rows[3]);
  rows[0] = shuffled<0, 1, 4, 5>(a, c);
  rows[1] = shuffled<0, 1, 4, 5>(b, d);
  rows[2] = shuffled<2, 3, 6, 7>(a, c);
  rows[3] = shuffled<2, 3, 6, 7>(b, d);
}

[[gnu::always_inline]] inline Lanes squareRoot(const Lanes& x) {
  Lanes result;
  for (int k = 0; k < kLanes; ++k) result[k] = __builtin_sqrt(x[k]);
  return result;
}

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
inline bool any(const LaneMask& mask) {
#if defined(__AVX512F__)
  return _mm512_test_epi64_mask(__m512i(mask), __m512i(mask)) != 0;
#elif defined(__AVX__)
  return __builtin_ia32_movmskpd256(Four(mask)) != 0;
#else
  std::int64_t found = 0;
  for (int k = 0; k < kLanes; ++k) found |= mask[k];
  return found != 0;
#endif
}

inline double sum(const Lanes& x) {
  double total = 0;
  for (int k = 0; k < kLanes; ++k) total += x[k];
  return total;
}

/// Horner's scheme; coefficients from the constant on.
template <std::size_t N>
[[gnu::always_inline]] inline Lanes polynomial(const double (&coefficients)[N], const Lanes& x) {
  Lanes result = coefficients[N - 1] - Lanes{};
  for (std::size_t i = N - 1; i-- > 0;) result = coefficients[i] + x * result;
  return result;
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

struct Lanes3 {
  Lanes x, y, z;
};

inline Lanes3 operator+(const Lanes3& a, const Lanes3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Lanes3 operator-(const Lanes3& a, const Lanes3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Lanes3 operator*(const Lanes& s, const Lanes3& a) { return {s * a.x, s * a.y, s * a.z}; }
inline Lanes3 operator*(double s, const Lanes3& a) { return {s * a.x, s * a.y, s * a.z}; }
inline Lanes dot(const Lanes3& a, const Lanes3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Lanes3 cross(const Lanes3& a, const Lanes3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

[[gnu::always_inline]] inline Lanes3 select(const LaneMask& mask, const Lanes3& a,
                                            const Lanes3& b) {
  return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z)};
}
inline Lanes3 negative(const Lanes3& a) { return {-a.x, -a.y, -a.z}; }

/// asin(sqrt(h)) / sqrt(h) for h up to 1/4, to 2e-17; a Chebyshev interpolant.
[[gnu::always_inline]] inline Lanes arcsineRatio(const Lanes& h) {
  constexpr double kCoefficients[] = {1.0,
                                      0.16666666666664942,
                                      0.07500000000385201,
                                      0.044642856805998936,
                                      0.03038195969768514,
                                      0.022371749733164054,
                                      0.01735977964134998,
                                      0.01388484282640208,
                                      0.012170138592391726,
                                      0.0065293020047365695,
                                      0.019513468251252167,
                                      -0.016187392271599134,
                                      0.03187962140081284};
  return polynomial(kCoefficients, h);
}

/// atan(u) / u for squares of u up to 1/4, to 4e-18; a Chebyshev interpolant.
[[gnu::always_inline]] inline Lanes arctangentRatio(const Lanes& square) {
  constexpr double kCoefficients[] = {1.0,
                                      -0.3333333333333278,
                                      0.19999999999875542,
                                      -0.14285714274692063,
                                      0.11111110602305971,
                                      -0.09090895058092312,
                                      0.07692057989976618,
                                      -0.06663667844183857,
                                      0.05857435765165694,
                                      -0.05118531938647954,
                                      0.041775850326747944,
                                      -0.027302779603074177,
                                      0.010030841489968486};
  return polynomial(kCoefficients, square);
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

}  // namespace
