// Loops over threads whose results do not depend on the number of threads, to the last bit.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace spherical_springs::core {

/// Below this a loop is over before a second thread has begun.
constexpr std::ptrdiff_t kWorthThreads = 4096;

/// Calls `body(i)` for i from 0 to `count` - 1; bodies must not write to the same place.
template <class Body>
void parallelFor(std::ptrdiff_t count, int threads, const Body& body) {
#pragma omp parallel for num_threads(threads) \
    schedule(static) if (threads > 1 && count >= kWorthThreads)
  for (std::ptrdiff_t i = 0; i < count; ++i) body(i);
}

/// Sum of `term(i)` for i from 0 to `count` - 1, by blocks of a fixed size.
template <class Term>
double parallelSum(std::ptrdiff_t count, int threads, const Term& term) {
  constexpr std::ptrdiff_t kBlock = 1024;
  const std::ptrdiff_t blocks = (count + kBlock - 1) / kBlock;
  std::vector<double> sums(blocks, 0);
#pragma omp parallel for num_threads(threads) \
    schedule(static) if (threads > 1 && count >= kWorthThreads)
  for (std::ptrdiff_t block = 0; block < blocks; ++block) {
    const std::ptrdiff_t end = std::min(count, (block + 1) * kBlock);
    double sum = 0;
    for (std::ptrdiff_t i = block * kBlock; i < end; ++i) sum += term(i);
    sums[block] = sum;
  }
  double total = 0;
  for (const double sum : sums) total += sum;
  return total;
}

}  // namespace spherical_springs::core
