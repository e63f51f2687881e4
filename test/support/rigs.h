// Rigs to calibrate: directions of which most mutual angles have been measured.
#pragma once

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "random.h"
#include "scenes.h"

namespace spherical_springs::core::testing {

struct Rig {
  Points truth;
  std::vector<Particle> particles;  ///< at random places, the first one at its own, pinned
  SpringLists springs;              ///< stiffness 1 / sigma^2

  Scene scene() const { return sceneOf(particles, springs); }
};

/// `count` directions, the angles between all of them measured with errors of deviation `sigma`
/// [rad], and from 10 directions on a tenth of the angles missing.
inline Rig rigOf(std::uint32_t count, double sigma, unsigned seed) {
  benchmark_scenes::Random random(seed);
  Rig rig;
  rig.truth.resize(3, count);
  rig.particles.resize(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    rig.truth.col(i) = random.direction();
    rig.particles[i].position = random.direction();
  }
  rig.particles[0].position = rig.truth.col(0);
  rig.particles[0].pinned = true;
  for (std::uint32_t j = 0; j < count; ++j) {
    for (std::uint32_t i = 0; i < j; ++i) {
      if (count >= 10 && random.unit() < 0.1) continue;
      const double angle = arc(rig.truth.col(i), rig.truth.col(j)).angle;
      rig.springs.get<AngleSpring>().push_back(
          angleSpring(i, j, std::clamp(angle + sigma * random.normal(), 0., kPi)));
      rig.springs.get<AngleSpring>().back().stiffness = 1 / (sigma * sigma);
    }
  }
  return rig;
}

/// The largest distance between points and others, after the turn that brings them closest.
inline double misfit(const Points& a, const Points& b) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(Eigen::Matrix3d(a * b.transpose()),
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d v = svd.matrixV();
  if ((v * svd.matrixU().transpose()).determinant() < 0) v.col(2) *= -1;
  return (v * svd.matrixU().transpose() * a - b).colwise().norm().maxCoeff();
}

inline Points mirrorImage(Points points) {
  points.row(2) *= -1;
  return points;
}

}  // namespace spherical_springs::core::testing
