#include "relaxation/torque_limit.h"

#include <algorithm>
#include <array>

#include "spherical_springs/range.h"

namespace spherical_springs::core {

TorqueLimit::TorqueLimit(const System& system, double bound) : bound_(bound) {
  if (!isRelative()) return;
  own_stiffness_ = Eigen::VectorXd::Zero(system.particleCount());
  forEachKind([&](auto kind) {
    for (const auto& spring : system.springs<typename decltype(kind)::type>()) {
      for (const std::uint32_t i : spring.particles) own_stiffness_[i] += spring.stiffness;
    }
  });
}

double largestTorque(const System& system, const Points& positions) {
  System::Workspace workspace;
  system.evaluate(positions, workspace);
  double largest = 0;
  for (Eigen::Index i = 0; i < positions.cols(); ++i) {
    if (!system.pinned(i)) largest = std::max(largest, workspace.torques.col(i).norm());
  }
  return largest;
}

Eigen::VectorXd feltStiffness(const System& system, const Points& positions) {
  Eigen::VectorXd stiffness = Eigen::VectorXd::Zero(system.particleCount());
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    for (const Spring& spring : system.springs<Spring>()) {
      const auto points = System::points(spring, positions);
      std::array<TangentFrame, Spring::kParticles> frames;
      for (std::size_t j = 0; j < frames.size(); ++j) frames[j] = tangentFrame(points[j]);
      const auto c = tangentCondition(spring, points, frames, Curvature::definite);
      for (std::size_t j = 0; j < frames.size(); ++j) {
        stiffness[spring.particles[j]] +=
            0.5 * spring.stiffness *
            (c.gradient[j].squaredNorm() + c.value * c.hessian[j][j].trace());
      }
    }
  });
  return stiffness;
}

Eigen::VectorXd allowedTorques(const System& system, const Points& positions,
                               const TorqueLimit& limit) {
  if (!limit.isRelative()) {
    return Eigen::VectorXd::Constant(system.particleCount(), limit.bound());
  }
  Eigen::VectorXd allowed = feltStiffness(system, positions);
  for (Eigen::Index i = 0; i < allowed.size(); ++i) allowed[i] = limit.allowed(i, allowed[i]);
  return allowed;
}

std::string excessInWords(const System& system, const Points& positions, const TorqueLimit& limit) {
  if (!limit.isRelative()) return ", tolerance " + toText(limit.bound()) + " N m";
  System::Workspace workspace;
  system.evaluate(positions, workspace);
  const Eigen::VectorXd allowed = allowedTorques(system, positions, limit);
  std::string words;
  double most = 1;
  for (Eigen::Index i = 0; i < allowed.size(); ++i) {
    const double torque = workspace.torques.col(i).norm();
    if (system.pinned(i) || !(excessOf(torque, allowed[i]) > most)) continue;
    most = excessOf(torque, allowed[i]);
    words = "; particle " + std::to_string(system.particleId(i)) + " is left with " +
            toText(torque) + " N m, allowed: " + toText(allowed[i]) +
            " N m, 1e-9 of the stiffness that it feels";
  }
  return words;
}

std::vector<bool> areWithin(const System& system, const Points& positions,
                            const TorqueLimit& limit) {
  System::Workspace workspace;
  system.evaluate(positions, workspace);
  const Eigen::VectorXd allowed = allowedTorques(system, positions, limit);
  std::vector<bool> within(positions.cols());
  for (Eigen::Index i = 0; i < positions.cols(); ++i) {
    within[i] = system.pinned(i) || excessOf(workspace.torques.col(i).norm(), allowed[i]) <= 1;
  }
  return within;
}

}  // namespace spherical_springs::core
