#include "maps/basin_hopping.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.h"
#include "maps/map_clock.h"
#include "maps/map_descent.h"

namespace spherical_springs::mesh {
namespace {

/// Mean share of the faces round each vertex.
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

/// Descents of the energy of a patch.
class PatchDescent {
 public:
  PatchDescent(const Patch& patch, const Points& points, double shape,
               const core::Checkpoint& checkpoint)
      : energy_(patch.faces, patch.shares, points, patch.free, 1),
        descent_(energy_, 1),
        shape_(shape),
        checkpoint_(checkpoint) {}

  double value() const { return energy_.valueHere(); }
  Points points() const { return energy_.points(); }

  /// @return the energy where the descent from there ends; infinity where faces fold.
  double settle(const Points& from, double slow) {
    begin(from, AreaCost::barrier, shape_);
    return std::isfinite(value()) ? descend(FaceHessian::exact, slow, 50) : value();
  }

  /// @return whether it ends lower than `before` by way of the squares, wherever faces fold.
  bool unfolds(const Points& from, double before) {
    constexpr double kHopeless = 1.2;  // of the energy before
    begin(from, AreaCost::square, 0);
    return std::isfinite(value()) &&  // not turned inside out
           descend(FaceHessian::gauss_newton, 3e-2, 40) < kHopeless * before &&
           descend(FaceHessian::exact, kSlow, 200) < before && settle(points(), kSlow) < before;
  }

 private:
  static constexpr double kSlow = 1e-4;  // drop of the energy in one step that ends a descent

  void begin(const Points& from, AreaCost cost, double shape) {
    descent_.restart();
    energy_.place(from);
    energy_.setCost(cost);
    energy_.setShape(shape);
  }

  /// @return the energy where it ends.
  double descend(FaceHessian hessian, double slow, int most_steps) {
    descent_.run(hessian, slow, [&] {
      checkpoint_();
      return most_steps-- > 0;
    });
    return value();
  }

  MapEnergy energy_;
  MapDescent descent_;
  double shape_;
  const core::Checkpoint& checkpoint_;
};

}  // namespace

BasinHopping::BasinHopping(const Faces& faces, const Eigen::VectorXd& shares, std::int32_t vertices,
                           double shape, int threads, core::Checkpoint checkpoint)
    : faces_(faces),
      shares_(shares),
      shape_(shape),
      threads_(threads),
      checkpoint_(std::move(checkpoint)),
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
  const std::vector<Hop> hops = drawHops(map);
  std::vector<Points> landings(hops.size());
  core::forOnThreads(static_cast<std::ptrdiff_t>(hops.size()), threads_, [&](std::ptrdiff_t h) {
    landings[h] = landing(hops[h], hops[h].patch.of(map));
  });
  for (std::size_t h = 0; h < hops.size(); ++h) hops[h].patch.putInto(map, landings[h]);
  return 1 - energies(map).sum() / before;
}

/// About faces that are drawn by the squares of their energies.
std::vector<BasinHopping::Hop> BasinHopping::drawHops(const Points& map) {
  constexpr std::size_t kMost = 8, kSize = 300;
  constexpr int kDraws = 20;  // some of which fall on patches that are there
  const Eigen::ArrayXd weights = energies(map).array().square();
  std::discrete_distribution<Eigen::Index> draw(weights.data(), weights.data() + weights.size());
  std::vector<Hop> hops;
  cutter_.begin();
  for (int drawn = 0; drawn < kDraws && hops.size() < kMost; ++drawn) {
    Patch patch = cutter_.cut(draw(random_), kSize);
    if (patch.free == 0) continue;
    hops.push_back({std::move(patch), static_cast<std::uint32_t>(random_())});
  }
  return hops;
}

/// The lowest of some tries in turn, each scattered from the lowest before it.
Points BasinHopping::landing(const Hop& hop, const Points& points) const {
  constexpr int kTries = 8;
  constexpr double kRough = 1e-2;  // more steps are lost where a hop goes elsewhere
  Points lowest = points;
  try {
    PatchDescent descent(hop.patch, points, shape_, checkpoint_);
    double least = descent.settle(points, kRough);
    lowest = descent.points();
    std::mt19937 random(hop.seed);
    for (int tried = 0; tried < kTries; ++tried) {
      if (!descent.unfolds(scattered(hop.patch, lowest, random), least)) continue;
      lowest = descent.points();
      least = descent.value();
    }
  } catch (const TimeIsOver&) {  // with the lowest so far
  }
  return lowest;
}

}  // namespace spherical_springs::mesh
