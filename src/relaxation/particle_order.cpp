#include "relaxation/particle_order.h"

#include <algorithm>

#include "base/buckets.h"
#include "geometry/curve_order.h"

namespace spherical_springs::core {

ParticleOrder particleOrder(const std::vector<bool>& free, const Points& positions) {
  ParticleOrder order;
  order.particles = curveOrder(positions);
  const auto free_end = std::stable_partition(order.particles.begin(), order.particles.end(),
                                              [&](std::uint32_t i) { return free[i]; });
  order.free_count = free_end - order.particles.begin();
  order.numbers.resize(order.particles.size());
  for (std::uint32_t n = 0; n < order.numbers.size(); ++n) order.numbers[order.particles[n]] = n;
  return order;
}

Graph freeGraph(const System& system, const ParticleOrder& order, int threads) {
  const std::size_t free = order.free_count;
  const auto& numbers = order.numbers;
  auto all = dealtOut<std::uint32_t>(free, [&](const auto& visit) {
    for (std::uint32_t i = 0; i < free; ++i) visit(i, i);
    forEachKind([&](auto kind) {
      for (const auto& spring : system.springs<typename decltype(kind)::type>()) {
        for (const std::uint32_t i : spring.particles) {
          for (const std::uint32_t j : spring.particles) {
            if (i != j && numbers[i] < free && numbers[j] < free) visit(numbers[i], numbers[j]);
          }
        }
      }
    });
  });
  std::vector<std::uint32_t> kept(free);
  parallelFor(free, threads, [&](std::ptrdiff_t i) {
    const auto begin = all.begin(i), end = all.end(i);
    std::sort(begin, end);
    kept[i] = static_cast<std::uint32_t>(std::unique(begin, end) - begin);
  });
  Graph graph;
  graph.first.assign(free + 1, 0);
  for (std::size_t i = 0; i < free; ++i) graph.first[i + 1] = graph.first[i] + kept[i];
  graph.neighbours.resize(graph.first.back());
  parallelFor(free, threads, [&](std::ptrdiff_t i) {
    std::copy_n(all.begin(i), kept[i], graph.neighbours.begin() + graph.first[i]);
  });
  return graph;
}

}  // namespace spherical_springs::core
