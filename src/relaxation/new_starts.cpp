#include "relaxation/new_starts.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace spherical_springs::core {
namespace {

/// For each particle the longest arc to another particle of its springs, or 1 where all are on one
/// spot [rad].
Eigen::VectorXd reach(const System& system, const Points& positions) {
  Eigen::VectorXd longest = Eigen::VectorXd::Zero(system.particleCount());
  forEachKind([&](auto kind) {
    for (const auto& spring : system.springs<typename decltype(kind)::type>()) {
      for (const std::uint32_t i : spring.particles) {
        for (const std::uint32_t j : spring.particles) {
          longest[i] = std::max(longest[i], arc(positions.col(i), positions.col(j)).angle);
        }
      }
    }
  });
  return (longest.array() > 0).select(longest, 1);
}

/// Returns whether the torques on the free ends of a spring are small beside its stiffness, as
/// where the scene is at rest. Elsewhere the torque of a spring that is nearly undefined is mostly
/// rounding.
template <class Spring>
bool isAtRest(const System& system, const Spring& spring, const Points& torques) {
  constexpr double kSmall = 1e-6;  // of the torque by the stiffness
  return std::all_of(spring.particles.begin(), spring.particles.end(), [&](std::uint32_t i) {
    return system.pinned(i) || torques.col(i).norm() < kSmall * spring.stiffness;
  });
}

/// Calls `visit(spring, index)` for each spring that `undefinedSpring` may name.
template <class Visitor>
void forEachUndefined(const System& system, const Points& positions, double near,
                      const Visitor& visit) {
  System::Workspace workspace;
  bool evaluated = false;
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    const auto& springs = system.springs<Spring>();
    for (std::size_t i = 0; i < springs.size(); ++i) {
      const auto points = System::points(springs[i], positions);
      const double distance = distanceToUndefined(springs[i], points);
      if (distance >= near) continue;
      if (!evaluated) system.evaluate(positions, workspace);
      evaluated = true;
      // At the very place the value is a convention, and nothing pulls.
      if (distance > 0 && isAtRest(system, springs[i], workspace.torques)) continue;
      visit(springs[i], i);
    }
  });
}

/// Moves free ends of springs in random directions.
class EndMover {
 public:
  EndMover(const System& system, double distance, unsigned seed)
      : system_(system), distance_(distance), generator_(seed) {}

  template <class Spring>
  void move(const Spring& spring, Points& positions) {
    for (const std::uint32_t i : spring.particles) {
      const double angle = 2 * kPi * (generator_() / (std::mt19937::max() + 1.));
      if (system_.pinned(i)) continue;
      const Vector3 p = positions.col(i);
      const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
      positions.col(i) = rotated(p, distance_ * (tangentFrame(p) * direction));
    }
  }

 private:
  const System& system_;
  double distance_;
  std::mt19937 generator_;
};

}  // namespace

Points displaced(const System& system, Points positions, double share, unsigned seed) {
  std::mt19937 generator(seed);
  const Eigen::VectorXd longest = reach(system, positions);
  for (Eigen::Index i = 0; i < positions.cols(); ++i) {
    Eigen::Vector2d step;
    for (int k = 0; k < 2; ++k) step[k] = generator() / (0.5 * std::mt19937::max()) - 1;
    if (system.pinned(i) || !system.joined(i)) continue;
    const Vector3 p = positions.col(i);
    positions.col(i) = rotated(p, share * longest[i] * (tangentFrame(p) * step));
  }
  return positions;
}

std::string undefinedSpring(const System& system, const Points& positions, double near) {
  std::string name;
  forEachUndefined(system, positions, near, [&](const auto& spring, std::size_t index) {
    if (name.empty()) name = nameOf<std::decay_t<decltype(spring)>>(system, index);
  });
  return name;
}

Points besideUndefined(const System& system, Points positions, double distance, unsigned seed) {
  EndMover mover(system, distance, seed);
  forEachUndefined(system, Points(positions), kUndefined,
                   [&](const auto& spring, std::size_t) { mover.move(spring, positions); });
  return positions;
}

Points besideFlat(const System& system, Points positions, double distance, unsigned seed) {
  EndMover mover(system, distance, seed);
  const Points from = positions;
  forEachKind([&](auto kind) {
    for (const auto& spring : system.springs<typename decltype(kind)::type>()) {
      if (isFlat(spring, System::points(spring, from))) mover.move(spring, positions);
    }
  });
  return positions;
}

}  // namespace spherical_springs::core
