#include "tangent_energy.h"

#include <algorithm>
#include <cmath>

#include "../parallel.h"

namespace spherical_springs::core {

TangentEnergy::TangentEnergy(const System& system, const Points& positions) : system_(system) {
  findFree();
  moveTo(positions);
}

TangentEnergy::TangentEnergy(const System& system, Eigen::VectorXd inertia)
    : system_(system), inertia_(std::move(inertia)) {
  findFree();
}

void TangentEnergy::findFree() {
  unknown_.assign(system_.particleCount(), -1);
  frames_.resize(system_.particleCount());
  for (Eigen::Index i = 0; i < system_.particleCount(); ++i) {
    if (system_.pinned(i)) continue;
    unknown_[i] = static_cast<Eigen::Index>(free_.size());
    free_.push_back(i);
  }
  gradient_.resize(unknowns());
}

double TangentEnergy::maxTorque() const {
  double largest = 0;
  for (Eigen::Index u = 0; u < unknowns(); u += 2) {
    largest = std::max(largest, gradient_.segment<2>(u).norm());
  }
  return largest;
}

Points TangentEnergy::moved(const Eigen::VectorXd& step) const {
  Points result = positions_;
  parallelFor(free_.size(), system_.threads(), [&](std::ptrdiff_t f) {
    const Eigen::Index i = free_[f];
    const Vector3 p = positions_.col(i);
    result.col(i) = rotated(p, p.cross(frames_[i] * step.segment<2>(2 * f)));
  });
  return result;
}

void TangentEnergy::moveTo(const Points& positions) {
  positions_ = positions;
  value_ = system_.potential(positions_).total();
  system_.evaluate(positions_, workspace_);
  if (inertia_.size() > 0) addInertia();
  parallelFor(system_.particleCount(), system_.threads(), [&](std::ptrdiff_t i) {
    const Vector3 p = positions_.col(i);
    frames_[i] = tangentFrame(p);
    if (unknown_[i] < 0) return;
    // torque = -p x grad, and grad is tangent, so grad = p x torque
    gradient_.segment<2>(2 * unknown_[i]) =
        frames_[i].transpose() * p.cross(workspace_.torques.col(i));
  });
}

void TangentEnergy::addInertia() {
  for (Eigen::Index i = 0; i < inertia_.size(); ++i) {
    const Arc way = arc(positions_.col(i), targets_.col(i));
    value_ += 0.5 * inertia_[i] * way.angle * way.angle;
    workspace_.torques.col(i) += inertia_[i] * way.angle * way.axis;
  }
}

namespace {

/// Frames of the particles of a spring.
template <class Spring>
std::array<TangentFrame, Spring::kParticles> framesOf(const Spring& spring,
                                                      const std::vector<TangentFrame>& frames) {
  std::array<TangentFrame, Spring::kParticles> result;
  for (std::size_t j = 0; j < Spring::kParticles; ++j) result[j] = frames[spring.particles[j]];
  return result;
}

/// Calls `visit(i, j)` for each pair of ends of a spring that has a block in the lower triangle.
template <class Spring, class Visitor>
void forEachBlock(const Spring& spring, const std::vector<Eigen::Index>& unknown,
                  const Visitor& visit) {
  for (std::size_t i = 0; i < Spring::kParticles; ++i) {
    const Eigen::Index row = unknown[spring.particles[i]];
    for (std::size_t j = 0; j < Spring::kParticles; ++j) {
      const Eigen::Index column = unknown[spring.particles[j]];
      if (column >= 0 && row >= column) visit(i, j, row, column);
    }
  }
}

}  // namespace

void TangentEnergy::buildPattern() {
  std::vector<Eigen::Triplet<double>> entries;
  const auto addBlock = [&](std::size_t, std::size_t, Eigen::Index row, Eigen::Index column) {
    for (int c = 0; c < 2; ++c) {
      for (int r = row == column ? c : 0; r < 2; ++r) {
        entries.emplace_back(2 * row + r, 2 * column + c, 0);
      }
    }
  };
  for (std::size_t f = 0; f < free_.size(); ++f) addBlock(0, 0, f, f);
  forEachKind([&](auto kind) {
    for (const auto& spring : system_.springs<typename decltype(kind)::type>()) {
      forEachBlock(spring, unknown_, addBlock);
    }
  });
  hessian_.resize(unknowns(), unknowns());
  hessian_.setFromTriplets(entries.begin(), entries.end());

  for (std::size_t f = 0; f < free_.size(); ++f) diagonal_blocks_.push_back(block(f, f));
  forEachKind([&](auto kind) {
    for (const auto& spring : system_.springs<typename decltype(kind)::type>()) {
      forEachBlock(spring, unknown_,
                   [&](std::size_t, std::size_t, Eigen::Index row, Eigen::Index column) {
                     blocks_.push_back(block(row, column));
                   });
    }
  });
}

TangentEnergy::Block TangentEnergy::block(Eigen::Index row, Eigen::Index column) const {
  Block result;
  for (int c = 0; c < 2; ++c) {
    const int first_row = static_cast<int>(row == column ? 2 * row + c : 2 * row);
    const int* begin = hessian_.innerIndexPtr() + hessian_.outerIndexPtr()[2 * column + c];
    const int* end = hessian_.innerIndexPtr() + hessian_.outerIndexPtr()[2 * column + c + 1];
    result[c] =
        static_cast<int>(std::lower_bound(begin, end, first_row) - hessian_.innerIndexPtr());
  }
  return result;
}

void TangentEnergy::add(const Block& block, bool diagonal, const Eigen::Matrix2d& values) {
  double* stored = hessian_.valuePtr();
  stored[block[0]] += values(0, 0);
  stored[block[0] + 1] += values(1, 0);
  if (diagonal) {
    stored[block[1]] += values(1, 1);
  } else {
    stored[block[1]] += values(0, 1);
    stored[block[1] + 1] += values(1, 1);
  }
}

const TangentEnergy::Matrix& TangentEnergy::hessian(Curvature curvature) {
  if (hessian_.cols() != unknowns()) buildPattern();
  std::fill_n(hessian_.valuePtr(), hessian_.nonZeros(), 0.);
  auto next = blocks_.begin();
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    for (const Spring& spring : system_.springs<Spring>()) {
      const auto c = tangentCondition(spring, System::points(spring, positions_),
                                      framesOf(spring, frames_), curvature);
      forEachBlock(spring, unknown_,
                   [&](std::size_t i, std::size_t j, Eigen::Index row, Eigen::Index column) {
                     add(*next++, row == column,
                         spring.stiffness * (c.gradient[i] * c.gradient[j].transpose() +
                                             c.value * c.hessian[i][j]));
                   });
    }
  });
  if (inertia_.size() > 0) addInertiaHessian(curvature);
  return hessian_;
}

// The distance from a target is the condition of an angle spring of rest angle 0 to a pinned one.
void TangentEnergy::addInertiaHessian(Curvature curvature) {
  for (std::size_t f = 0; f < free_.size(); ++f) {
    const Eigen::Index i = free_[f];
    const auto c = tangentCondition(AngleSpring(), {positions_.col(i), targets_.col(i)},
                                    {frames_[i], frames_[i]}, curvature);
    add(diagonal_blocks_[f], true,
        inertia_[i] * (c.gradient[0] * c.gradient[0].transpose() + c.value * c.hessian[0][0]));
  }
}

Eigen::VectorXd TangentEnergy::particleStiffness() const {
  constexpr double kLeastShare = 1e-12;
  Eigen::VectorXd stiffness = Eigen::VectorXd::Zero(system_.particleCount());
  forEachKind([&](auto kind) {
    for (const auto& spring : system_.springs<typename decltype(kind)::type>()) {
      const auto c = condition(spring, System::points(spring, positions_));
      for (std::size_t j = 0; j < spring.particles.size(); ++j) {
        stiffness[spring.particles[j]] += spring.stiffness * c.gradient[j].squaredNorm();
      }
    }
  });
  if (inertia_.size() > 0) stiffness += inertia_;
  const double largest = stiffness.size() > 0 ? stiffness.maxCoeff() : 0;
  return stiffness.cwiseMax(largest > 0 ? kLeastShare * largest : 1);
}

Eigen::VectorXd TangentEnergy::stiffnessScale() const {
  const Eigen::VectorXd stiffness = particleStiffness();
  Eigen::VectorXd scale(unknowns());
  for (std::size_t f = 0; f < free_.size(); ++f) {
    scale.segment<2>(2 * f).setConstant(stiffness[free_[f]]);
  }
  return scale;
}

Eigen::VectorXd TangentEnergy::mobility() const {
  Eigen::VectorXd result = particleStiffness().cwiseInverse();
  for (Eigen::Index i = 0; i < result.size(); ++i) {
    if (system_.pinned(i)) result[i] = 0;
  }
  return result;
}

}  // namespace spherical_springs::core
