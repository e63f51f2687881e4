#include "stepping/stability.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace spherical_springs::core {
namespace {

/// Adds the blocks of a spring's stiffness, in units of acceleration, to the sums of its particles:
/// those on the diagonal as they are, the norms of the others.
template <class Spring>
void addCircles(const Spring& spring, const System& system, const Points& positions,
                std::vector<Eigen::Matrix2d>& diagonal, Eigen::VectorXd& others) {
  constexpr std::size_t N = Spring::kParticles;
  const auto points = System::points(spring, positions);
  std::array<TangentFrame, N> frames;
  for (std::size_t j = 0; j < N; ++j) frames[j] = tangentFrame(points[j]);
  const auto c = tangentCondition(spring, points, frames, Curvature::exact);
  for (std::size_t i = 0; i < N; ++i) {
    const std::uint32_t row = spring.particles[i];
    for (std::size_t j = 0; j < N; ++j) {
      const std::uint32_t column = spring.particles[j];
      const double mobility =
          std::sqrt(system.inverseMasses()[row] * system.inverseMasses()[column]);
      const Eigen::Matrix2d block =
          spring.stiffness * mobility *
          (c.gradient[i] * c.gradient[j].transpose() + c.value * c.hessian[i][j]);
      if (i == j) {
        diagonal[row] += block;
      } else {
        others[row] += block.norm();
      }
    }
  }
}

double largestEigenvalue(const Eigen::Matrix2d& m) {
  const double difference = (m(0, 0) - m(1, 1)) / 2;
  return (m(0, 0) + m(1, 1)) / 2 + std::hypot(difference, m(0, 1));
}

}  // namespace

double highestFrequency(const System& system, const Points& positions) {
  std::vector<Eigen::Matrix2d> diagonal(system.particleCount(), Eigen::Matrix2d::Zero());
  Eigen::VectorXd others = Eigen::VectorXd::Zero(system.particleCount());
  forEachKind([&](auto kind) {
    for (const auto& spring : system.springs<typename decltype(kind)::type>()) {
      addCircles(spring, system, positions, diagonal, others);
    }
  });
  double squared = 0;
  for (Eigen::Index i = 0; i < system.particleCount(); ++i) {
    squared = std::max(squared, largestEigenvalue(diagonal[i]) + others[i]);
  }
  return std::sqrt(squared);
}

}  // namespace spherical_springs::core
