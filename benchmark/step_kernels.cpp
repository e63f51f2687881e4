// The kernels of a step, for every instruction set that this processor has.
#include <benchmark/benchmark.h>

#include <cmath>
#include <string>
#include <vector>

#include "support/step_levels.h"

namespace {

using namespace spherical_springs::core;  // NOLINT: a program, not a header

/// A square of a triangular lattice, on which no two elements taken together meet.
struct Lattice {
  static constexpr std::uint32_t kSide = 32, kParticles = kSide * kSide;
  static constexpr double kEdge = 0.03;

  std::vector<Row> positions{kParticles}, moved{kParticles}, forces{kParticles};
  std::vector<double> velocities = std::vector<double>(3 * kParticles, 0.01);
  std::vector<double> inverse_masses = std::vector<double>(kParticles, 1e-3);

  Lattice() {
    for (std::uint32_t i = 0; i < kParticles; ++i) {
      const double row = i / kSide, column = i % kSide;
      const double x = kEdge * (column + row / 2), y = kEdge * row * std::sqrt(0.75);
      const double norm = std::sqrt(1 + x * x + y * y);
      positions[i] = {{x / norm, y / norm, 1 / norm, 0}};
    }
  }

  Particles particles() {
    return {positions[0].values,
            moved[0].values,
            {&velocities[0], &velocities[kParticles], &velocities[2 * kParticles]},
            forces[0].values,
            inverse_masses.data(),
            kParticles};
  }

  template <int kEnds, int kSprings>
  static void fill(std::vector<ElementGroup<kEnds, kSprings>>& groups) {
    constexpr std::uint32_t kRows = kSide - 1;
    groups.resize(2 * kRows * kRows / kGroup);
    for (std::uint32_t e = 0; e < groups.size() * kGroup; ++e) {
      const std::uint32_t cell = e / 2, corner = cell / kRows * kSide + cell % kRows;
      const std::uint32_t up[3] = {corner, corner + 1, corner + kSide};
      const std::uint32_t down[3] = {corner + kSide + 1, corner + kSide, corner + 1};
      auto& group = groups[e % groups.size()];
      const std::size_t lane = e / groups.size();
      for (int i = 0; i < kEnds; ++i) {
        group.ends[i][lane] = static_cast<std::uint32_t>(kRowLength * (e % 2 == 0 ? up : down)[i]);
      }
      for (auto& spring : group.springs) {
        spring.rest[lane] = kEdge;
        spring.stiffness[lane] = 1;
      }
    }
  }
};

template <class Group>
void forces(benchmark::State& state, const StepKernels* kernels) {
  Lattice lattice;
  std::vector<Group> groups;
  Lattice::fill(groups);
  std::vector<std::uint32_t> hard(groups.size() * kGroup), near(groups.size() * kGroup);
  const auto count = static_cast<std::uint32_t>(groups.size());
  for (auto _ : state) {
    MarkedElements marked{hard.data(), near.data()};
    std::get<ForceKernel<Group>>(kernels->forces)(groups.data(), count, lattice.positions[0].values,
                                                  lattice.forces[0].values, marked);
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * groups.size() * kGroup));
}

void kick(benchmark::State& state, const StepKernels* kernels) {
  Lattice lattice;
  for (auto _ : state) {
    kernels->kick(lattice.particles(), 1e-3);
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * Lattice::kParticles));
}

void drift(benchmark::State& state, const StepKernels* kernels) {
  Lattice lattice;
  for (auto _ : state) {
    kernels->drift(lattice.particles(), 1e-3);
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * Lattice::kParticles));
}

}  // namespace

int main(int argc, char** argv) {
  const char* const names[] = {"plain/", "avx2/", "avx512/"};
  const auto levels = testing::stepKernelsHere();
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const std::string level = names[i];
    benchmark::RegisterBenchmark((level + "arcs").c_str(), forces<Arcs>, levels[i]);
    benchmark::RegisterBenchmark((level + "triangles").c_str(), forces<Triangles<0>>, levels[i]);
    benchmark::RegisterBenchmark((level + "triangles_with_one_arc").c_str(), forces<Triangles<1>>,
                                 levels[i]);
    benchmark::RegisterBenchmark((level + "triangles_with_two_arcs").c_str(), forces<Triangles<2>>,
                                 levels[i]);
    benchmark::RegisterBenchmark((level + "kick").c_str(), kick, levels[i]);
    benchmark::RegisterBenchmark((level + "drift").c_str(), drift, levels[i]);
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
