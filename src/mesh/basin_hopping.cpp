#include "basin_hopping.h"

#include <cmath>
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

}  // namespace

BasinHopping::BasinHopping(const Faces& faces, const Eigen::VectorXd& shares, std::int32_t vertices,
                           double shape, int threads)
    : faces_(faces),
      shares_(shares),
      shape_(shape),
      threads_(threads),
      cutter_(faces, shares, vertices) {}

/// One a face.
Eigen::VectorXd BasinHopping::energies(const Faces& faces, const Eigen::VectorXd& shares,
                                       const Points& points) const {
  Eigen::VectorXd result(faces.cols());
  for (Eigen::Index f = 0; f < faces.cols(); ++f) {
    const auto corner = [&](int k) { return points.col(faces(k, f)); };
    result[f] = FaceEnergy{shares[f], 1, shape_}.value({corner(0), corner(1), corner(2)});
  }
  return result;
}

/// Where descent leads from `points`.
Points BasinHopping::descended(const Patch& patch, const Eigen::VectorXd& shares,
                               const Points& points, double slow) const {
  constexpr int kMostSteps = 200;
  MapEnergy energy(patch.faces, shares, points, patch.free, 1);
  energy.setShape(shape_);
  int steps = 0;
  MapDescent(energy, 1).run(FaceHessian::exact, slow, [&] { return steps++ < kMostSteps; });
  return energy.points();
}

Points BasinHopping::hopped(const Patch& patch, const Points& points, std::uint32_t seed) const {
  constexpr double kSlowAway = 1e-2, kSlowBack = 1e-4;  // drops in one step that end it
  const Points away = descended(patch, shaken(patch, seed), points, kSlowAway);
  return descended(patch, patch.shares, away, kSlowBack);
}

/// Each try is on a patch about a face that is drawn by its energy, or where that is in one of the
/// patches before, or next to it, on the last of those.
std::vector<Patch> BasinHopping::drawPatches(std::size_t size, const Points& map,
                                             std::vector<Try>& tries) {
  const Eigen::VectorXd weights = energies(faces_, shares_, map);
  std::discrete_distribution<Eigen::Index> by_energy(weights.begin(), weights.end());
  std::vector<Patch> patches;
  cutter_.begin();
  for (Try& one : tries) {
    Patch patch = cutter_.cut(by_energy(random_), size);
    if (patch.free > 0) patches.push_back(std::move(patch));
    one.patch = patches.size() - 1;
    one.seed = static_cast<std::uint32_t>(random_());
  }
  return patches;
}

double BasinHopping::hop(Points& map) {
  const double before = energies(faces_, shares_, map).sum();
  for (const std::size_t size : {400, 800}) hop(size, map);
  return 1 - energies(faces_, shares_, map).sum() / before;
}

void BasinHopping::hop(std::size_t size, Points& map) {
  std::vector<Try> tries(4);
  const std::vector<Patch> patches = drawPatches(size, map, tries);
  core::forOnThreads(static_cast<std::ptrdiff_t>(tries.size()), threads_, [&](std::ptrdiff_t t) {
    const Patch& patch = patches[tries[t].patch];
    tries[t].points = hopped(patch, patch.of(map), tries[t].seed);
  });
  std::vector<double> lowest;
  for (const Patch& patch : patches) {
    lowest.push_back(energies(patch.faces, patch.shares, patch.of(map)).sum());
  }
  for (const Try& one : tries) {
    const Patch& patch = patches[one.patch];
    const double energy = energies(patch.faces, patch.shares, one.points).sum();
    if (!(energy < lowest[one.patch])) continue;
    lowest[one.patch] = energy;
    patch.putInto(map, one.points);
  }
}

}  // namespace spherical_springs::mesh
