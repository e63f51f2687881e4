// Loops over threads whose results do not depend on the number of threads, to the last bit.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <numeric>
#include <vector>

#include "base/workers.h"

namespace spherical_springs::core {

/// The number of threads worth their start for a loop over `count` springs or particles.
inline int worthwhileThreads(std::ptrdiff_t count, int threads) {
  constexpr std::ptrdiff_t kTooShort = 4096;  // over before a second thread has begun
  return count < kTooShort ? 1 : threads;
}

/// Calls `body(i)` for i from 0 to `count` - 1 on up to `threads` threads.
/// @throw what a body throws, the first one on any thread; bodies are left out then, but none is
/// still under way.
template <class Body>
void forOnThreads(std::ptrdiff_t count, int threads, const Body& body) {
  constexpr std::ptrdiff_t kPartsEach = 4;  // of which a thread may leave some to others
  const std::ptrdiff_t parts =
      threads > 1 ? std::min({count, kPartsEach * threads, Workers::kMostParts}) : 1;
  if (parts <= 1) {
    for (std::ptrdiff_t i = 0; i < count; ++i) body(i);
    return;
  }
  Workers::shared().run(threads, parts, [&](std::ptrdiff_t part) {
    const std::ptrdiff_t end = count * (part + 1) / parts;
    for (std::ptrdiff_t i = count * part / parts; i < end; ++i) body(i);
  });
}

/// Calls `body(i)` for i from 0 to `count` - 1; bodies must not write to the same place.
template <class Body>
void parallelFor(std::ptrdiff_t count, int threads, const Body& body) {
  forOnThreads(count, worthwhileThreads(count, threads), body);
}

/// `start` combined with `term(i)` for i from 0 to `count` - 1, by blocks of a fixed size, each of
/// which begins with `start` too.
template <class Value, class Term, class Combine>
Value parallelFold(std::ptrdiff_t count, int threads, const Value& start, const Term& term,
                   const Combine& combine) {
  constexpr std::ptrdiff_t kBlock = 1024;
  const std::ptrdiff_t blocks = (count + kBlock - 1) / kBlock;
  std::vector<Value> values(blocks, start);
  forOnThreads(blocks, worthwhileThreads(count, threads), [&](std::ptrdiff_t block) {
    const std::ptrdiff_t end = std::min(count, (block + 1) * kBlock);
    Value value = start;
    for (std::ptrdiff_t i = block * kBlock; i < end; ++i) value = combine(value, term(i));
    values[block] = value;
  });
  return std::accumulate(values.begin(), values.end(), start, combine);
}

/// Sum of `term(i)` for i from 0 to `count` - 1.
template <class Term>
double parallelSum(std::ptrdiff_t count, int threads, const Term& term) {
  return parallelFold(count, threads, 0., term, std::plus<>());
}

/// The largest `term(i)` for i from 0 to `count` - 1, or 0.
template <class Term>
double parallelLargest(std::ptrdiff_t count, int threads, const Term& term) {
  return parallelFold(count, threads, 0., term, [](double a, double b) { return std::max(a, b); });
}

}  // namespace spherical_springs::core
