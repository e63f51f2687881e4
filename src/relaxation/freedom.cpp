#include "relaxation/freedom.h"

#include <cmath>

#include "relaxation/free_groups.h"

namespace spherical_springs::core {
namespace {

double totalStiffness(const System& system) {
  double sum = 0;
  forEachKind([&](auto kind) {
    for (const auto& spring : system.springs<typename decltype(kind)::type>()) {
      sum += spring.stiffness;
    }
  });
  return sum;
}

}  // namespace

// Strains that a tolerance of 1e-9 rad leaves count as nothing.
Eigen::VectorXd roundingOf(const Eigen::VectorXd& energies, const Eigen::VectorXd& stiffness) {
  constexpr double kShare = 1e-9, kStrain = 1e-8;  // [rad]
  return kShare * energies + kStrain * kStrain * stiffness;
}

void judge(const System& system, RelaxationResult& result) {
  const FreeGroups groups(system);
  const Points& positions = result.positions;
  const Eigen::VectorXd energies = groups.energies(positions);
  const Eigen::VectorXd mirrored = groups.energies(groups.mirrored(positions));
  const Eigen::VectorXd rounding = roundingOf(energies, groups.stiffness());
  result.free_rotations = 0;
  result.mirror_ambiguous = false;
  for (std::size_t g = 0; g < groups.count(); ++g) {
    result.free_rotations += groups.rotations(g, positions);
    const bool alike = std::abs(mirrored[g] - energies[g]) <= rounding[g];
    result.mirror_ambiguous = result.mirror_ambiguous || (alike && !groups.isFlat(g, positions));
  }
  const double stiffness = totalStiffness(system);
  const double energy = system.potential(positions).total();
  result.rms_strain = stiffness > 0 ? std::sqrt(2 * energy / stiffness) : 0;
}

}  // namespace spherical_springs::core
