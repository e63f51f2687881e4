#include "relaxation/free_groups.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "base/parallel.h"
#include "system/groups.h"

namespace spherical_springs::core {
namespace {

constexpr std::uint32_t kNone = ~0u;
constexpr double kSmall = 1e-6;  // [rad]

/// The sum of p p^T over some particles. Its eigenvalues are sums of squared distances.
Eigen::Matrix3d scatter(const std::vector<std::uint32_t>& particles, const Points& positions) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const std::uint32_t i : particles) sum += positions.col(i) * positions.col(i).transpose();
  return sum;
}

template <class Spring>
double energyOf(const Spring& spring, const Points& positions) {
  const double c = condition(spring, System::points(spring, positions)).value;
  return 0.5 * spring.stiffness * c * c;
}

/// Whether the `rank` greatest eigenvalues are all that is not small.
bool hasRank(int rank, const Eigen::Matrix3d& scatter) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter, Eigen::EigenvaluesOnly);
  return solver.eigenvalues().head(3 - rank).sum() <= kSmall * kSmall * scatter.trace();
}

}  // namespace

FreeGroups::FreeGroups(const System& system)
    : system_(system), group_of_(groupsOf(system, Pins::part)) {
  std::vector<std::uint32_t> number(group_of_.size(), kNone);
  for (std::uint32_t i = 0; i < group_of_.size(); ++i) {
    std::uint32_t& group = group_of_[i];
    if (system.pinned(i) || !system.joined(i)) {
      group = kNone;
      continue;
    }
    if (number[group] == kNone) {
      number[group] = static_cast<std::uint32_t>(groups_.size());
      groups_.emplace_back();
    }
    group = number[group];
    groups_[group].particles.push_back(i);
  }
  stiffness_.setZero(static_cast<Eigen::Index>(groups_.size()));
  forEachKind([&](auto kind) {
    for (const auto& spring : system.springs<typename decltype(kind)::type>()) {
      const std::uint32_t group = groupOf(spring);
      if (group == kNone) continue;
      stiffness_[group] += spring.stiffness;
      for (const std::uint32_t i : spring.particles) {
        if (system.pinned(i)) groups_[group].pins.push_back(i);
      }
    }
  });
  for (Group& group : groups_) {
    std::sort(group.pins.begin(), group.pins.end());
    group.pins.erase(std::unique(group.pins.begin(), group.pins.end()), group.pins.end());
  }
}

/// The group of the free particles of a spring, or kNone.
template <class Spring>
std::uint32_t FreeGroups::groupOf(const Spring& spring) const {
  std::uint32_t group = kNone;
  for (const std::uint32_t i : spring.particles) group = std::min(group, group_of_[i]);
  return group;
}

Eigen::VectorXd FreeGroups::energies(const Points& positions) const {
  Eigen::VectorXd energies = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(count()));
  forEachKind([&](auto kind) {
    const auto& springs = system_.springs<typename decltype(kind)::type>();
    std::vector<double> values(springs.size());
    parallelFor(springs.size(), system_.threads(),
                [&](std::ptrdiff_t s) { values[s] = energyOf(springs[s], positions); });
    for (std::size_t s = 0; s < springs.size(); ++s) {
      const std::uint32_t group = groupOf(springs[s]);
      if (group != kNone) energies[group] += values[s];
    }
  });
  return energies;
}

FreeGroups::MirrorEnergies FreeGroups::mirrorEnergies(const Points& positions) const {
  const auto groups = static_cast<Eigen::Index>(count());
  MirrorEnergies sums{Eigen::VectorXd::Zero(groups), Eigen::VectorXd::Zero(groups)};
  const Points mirror_image = mirrored(positions);
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    const auto& springs = system_.springs<Spring>();
    const auto mayTell = [&](const Spring& spring) {
      return Spring::kParticles > 2 || system_.pinned(spring.particles[0]) ||
             system_.pinned(spring.particles[1]);
    };
    std::vector<double> here(springs.size(), 0), there(springs.size(), 0);
    parallelFor(springs.size(), system_.threads(), [&](std::ptrdiff_t s) {
      if (!mayTell(springs[s])) return;
      here[s] = energyOf(springs[s], positions);
      there[s] = energyOf(springs[s], mirror_image);
    });
    for (std::size_t s = 0; s < springs.size(); ++s) {
      const std::uint32_t group = groupOf(springs[s]);
      if (group == kNone) continue;
      sums.here[group] += here[s];
      sums.mirrored[group] += there[s];
    }
  });
  return sums;
}

Eigen::Matrix3Xd FreeGroups::axes(std::size_t group, const Points& positions) const {
  const auto& pins = groups_[group].pins;
  if (pins.empty()) return Eigen::Matrix3d::Identity();
  const Vector3 axis = positions.col(pins.front());
  const bool on_axis = std::all_of(pins.begin(), pins.end(), [&](std::uint32_t i) {
    return crossOfUnits(axis, positions.col(i)).isZero(0);
  });
  if (!on_axis) return Eigen::Matrix3Xd(3, 0);
  return axis;
}

std::uint32_t FreeGroups::rotations(std::size_t group, const Points& positions) const {
  const auto count = static_cast<std::uint32_t>(axes(group, positions).cols());
  if (count == 0) return 0;
  // A single axis is the one that the pinned particles lie on.
  Eigen::Matrix3d sum = scatter(groups_[group].particles, positions);
  if (count == 1) sum += scatter(groups_[group].pins, positions);
  return hasRank(1, sum) ? count - 1 : count;
}

bool FreeGroups::isFlat(std::size_t group, const Points& positions) const {
  const auto& [particles, pins] = groups_[group];
  return hasRank(2, scatter(particles, positions) + scatter(pins, positions));
}

Points FreeGroups::mirrored(Points positions) const {
  for (const auto& [particles, pins] : groups_) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter(pins, positions));
    const Vector3 normal = solver.eigenvectors().col(0);  // of the least eigenvalue
    for (const std::uint32_t i : particles) {
      const Vector3 p = positions.col(i);
      positions.col(i) = direction(p - 2 * normal.dot(p) * normal);
    }
  }
  return positions;
}

}  // namespace spherical_springs::core
