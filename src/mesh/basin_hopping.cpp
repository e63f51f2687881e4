#include "basin_hopping.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "../parallel.h"
#include "map_descent.h"

namespace spherical_springs::mesh {
namespace {

/// Of the faces round each vertex.
Eigen::ArrayXd meanShares(const Patch& patch) {
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(static_cast<Eigen::Index>(patch.vertices.size()));
  Eigen::ArrayXd count = sum;
  for (Eigen::Index c = 0; c < patch.faces.size(); ++c) {
    sum[patch.faces(c)] += patch.shares[c / 3];
    ++count[patch.faces(c)];
  }
  return sum / count;
}

/// With some vertices of the middle moved by several sizes of the faces round them.
Points scattered(const Patch& patch, Points points, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform;
  const auto logUniform = [&](double least, double most) {
    return least * std::pow(most / least, uniform(random));
  };
  const auto count = static_cast<std::int32_t>(logUniform(3, 41));
  const double distance = logUniform(2, 8);  // in roots of a share
  const Eigen::ArrayXd sizes = meanShares(patch).sqrt();
  std::normal_distribution<double> normal;
  for (std::int32_t n = 0; n < std::min(count, patch.free); ++n) {
    for (int k = 0; k < 3; ++k) points(k, n) += distance * sizes[n] * normal(random);
    points.col(n).normalize();
  }
  return points;
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
Eigen::VectorXd BasinHopping::energies(const Points& map) const {
  Eigen::VectorXd result(faces_.cols());
  for (Eigen::Index f = 0; f < faces_.cols(); ++f) {
    const auto corner = [&](int k) { return map.col(faces_(k, f)); };
    result[f] = FaceEnergy{shares_[f], 1, shape_}.value({corner(0), corner(1), corner(2)});
  }
  return result;
}

double BasinHopping::hop(Points& map) {
  const double before = energies(map).sum();
  for (const std::size_t size : {150, 600}) hop(size, map);
  return 1 - energies(map).sum() / before;
}

void BasinHopping::hop(std::size_t size, Points& map) {
  const std::vector<Hop> hops = drawHops(size, map);
  std::vector<Points> landings(hops.size());
  core::forOnThreads(static_cast<std::ptrdiff_t>(hops.size()), threads_, [&](std::ptrdiff_t h) {
    landings[h] = landing(hops[h], hops[h].patch.of(map));
  });
  for (std::size_t h = 0; h < hops.size(); ++h) hops[h].patch.putInto(map, landings[h]);
}

/// About faces that are drawn by the squares of their energies.
std::vector<BasinHopping::Hop> BasinHopping::drawHops(std::size_t size, const Points& map) {
  constexpr std::size_t kMost = 8;
  constexpr int kDraws = 20;  // some of which fall on patches that are there
  const Eigen::ArrayXd weights = energies(map).array().square();
  std::discrete_distribution<Eigen::Index> draw(weights.data(), weights.data() + weights.size());
  std::vector<Hop> hops;
  cutter_.begin();
  for (int drawn = 0; drawn < kDraws && hops.size() < kMost; ++drawn) {
    Patch patch = cutter_.cut(draw(random_), size);
    if (patch.free == 0) continue;
    hops.push_back({std::move(patch), static_cast<std::uint32_t>(random_())});
  }
  return hops;
}

/// Of the first of a few tries that ends lower than `points`, or these.
Points BasinHopping::landing(const Hop& hop, const Points& points) const {
  constexpr int kTries = 4;
  const Patch& patch = hop.patch;
  MapEnergy energy(patch.faces, patch.shares, points, patch.free, 1);
  energy.setShape(shape_);
  const double before = energy.valueHere();
  std::mt19937 random(hop.seed);
  for (int tried = 0; tried < kTries; ++tried) {
    if (lowered(energy, scattered(patch, points, random), before)) return energy.points();
  }
  return points;
}

/// Descends from some points, as long as that may end lower than `before`.
/// @return whether it does.
bool BasinHopping::lowered(MapEnergy& energy, const Points& from, double before) const {
  constexpr double kHopeless = 1.5;  // of the energy before
  MapDescent descent(energy, 1);
  const auto descend = [&](FaceHessian hessian, double slow, int most_steps) {
    descent.run(hessian, slow, [&] { return most_steps-- > 0; });
    return energy.valueHere();
  };
  energy.place(from);
  energy.setCost(AreaCost::square);
  energy.setShape(0);
  if (!std::isfinite(energy.valueHere())) return false;  // turned inside out
  if (descend(FaceHessian::gauss_newton, 3e-2, 40) > kHopeless * before) return false;
  if (descend(FaceHessian::exact, 1e-4, 200) > before) return false;
  energy.setCost(AreaCost::barrier);
  energy.setShape(shape_);
  if (!std::isfinite(energy.valueHere())) return false;  // folds are left
  return descend(FaceHessian::exact, 1e-4, 50) < before;
}

}  // namespace spherical_springs::mesh
