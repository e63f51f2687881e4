#include "basin_hopping.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "../parallel.h"
#include "map_descent.h"

namespace spherical_springs::mesh {
namespace {

/// With noise in the middle of a patch.
Eigen::VectorXd shaken(const Patch& patch, std::uint32_t seed) {
  constexpr std::int32_t kMiddle = 40;  // vertices
  constexpr double kNoise = 0.6;        // of logarithms
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, kNoise);
  Eigen::VectorXd shares = patch.shares;
  for (Eigen::Index f = 0; f < shares.size(); ++f) {
    if (patch.faces.col(f).maxCoeff() < kMiddle) shares[f] *= std::exp(normal(random));
  }
  return shares;
}

/// Where descent leads from `points`.
std::pair<Points, double> descended(const Patch& patch, const Eigen::VectorXd& shares,
                                    const Points& points, double slow) {
  constexpr int kMostSteps = 200;
  MapEnergy energy(patch.faces, shares, points, patch.free, 1);
  int steps = 0;
  MapDescent(energy, 1).run(FaceHessian::exact, slow, [&] { return steps++ < kMostSteps; });
  return {energy.points(), energy.valueHere()};
}

double valueOf(const Patch& patch, const Points& points) {
  MapEnergy energy(patch.faces, patch.shares, points, patch.free, 1);
  return energy.valueHere();
}

}  // namespace

BasinHopping::BasinHopping(const Faces& faces, const Eigen::VectorXd& shares, std::int32_t vertices,
                           int threads)
    : faces_(faces),
      shares_(shares),
      vertices_(static_cast<std::size_t>(vertices)),
      threads_(threads),
      cutter_(faces, shares, vertices) {}

Eigen::VectorXd BasinHopping::energies(const Points& map) const {
  Eigen::VectorXd result(faces_.cols());
  core::parallelFor(faces_.cols(), threads_, [&](std::ptrdiff_t f) {
    const FaceEnergy energy{shares_[f], 1, 0};
    result[f] = energy.value({map.col(faces_(0, f)), map.col(faces_(1, f)), map.col(faces_(2, f))});
  });
  return result;
}

/// Each try is on a patch about a face that is drawn by its energy, or where that is in one of the
/// patches before, or next to it, on the last of those.
std::vector<Patch> BasinHopping::drawPatches(std::size_t size, const Eigen::VectorXd& energies,
                                             std::vector<Try>& tries) {
  std::discrete_distribution<Eigen::Index> by_energy(energies.begin(), energies.end());
  std::vector<Patch> patches;
  cutter_.begin();
  for (Try& one : tries) {
    Patch patch = cutter_.cut(by_energy(random_), std::min(size, vertices_ / 2));
    if (patch.free > 0) patches.push_back(std::move(patch));
    one.patch = patches.size() - 1;
    one.seed = static_cast<std::uint32_t>(random_());
  }
  return patches;
}

double BasinHopping::hop(Points& map) {
  const double before = energies(map).sum();
  for (const std::size_t size : {400, 800}) hop(size, map);
  return 1 - energies(map).sum() / before;
}

void BasinHopping::hop(std::size_t size, Points& map) {
  constexpr std::size_t kTries = 4;
  constexpr double kSlowAway = 1e-2, kSlowBack = 1e-4;  // drops in one step that end it
  std::vector<Try> tries(kTries);
  const std::vector<Patch> patches = drawPatches(size, energies(map), tries);
  core::forOnThreads(kTries, threads_, [&](std::ptrdiff_t t) {
    const Patch& patch = patches[tries[t].patch];
    const Points start =
        descended(patch, shaken(patch, tries[t].seed), patch.of(map), kSlowAway).first;
    std::tie(tries[t].points, tries[t].energy) = descended(patch, patch.shares, start, kSlowBack);
  });
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const Try* best = nullptr;
    for (const Try& one : tries) {
      if (one.patch == p && (best == nullptr || one.energy < best->energy)) best = &one;
    }
    if (best->energy < valueOf(patches[p], patches[p].of(map))) {
      patches[p].putInto(map, best->points);
    }
  }
}

}  // namespace spherical_springs::mesh
