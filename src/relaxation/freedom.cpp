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

std::vector<bool> mirrorImagesDiffer(const FreeGroups& groups, const Points& positions) {
  const FreeGroups::MirrorEnergies energies = groups.mirrorEnergies(positions);
  const Eigen::VectorXd rounding = roundingOf(energies.here, groups.stiffness());
  std::vector<bool> differ(groups.count());
  for (std::size_t g = 0; g < differ.size(); ++g) {
    differ[g] = std::abs(energies.mirrored[g] - energies.here[g]) > rounding[g];
  }
  return differ;
}

void judge(const System& system, RelaxationResult& result) {
  const FreeGroups groups(system);
  const Points& positions = result.positions;
  const std::vector<bool> differ = mirrorImagesDiffer(groups, positions);
  result.free_rotations = 0;
  result.mirror_ambiguous = false;
  for (std::size_t g = 0; g < groups.count(); ++g) {
    result.free_rotations += groups.rotations(g, positions);
    result.mirror_ambiguous =
        result.mirror_ambiguous || (!differ[g] && !groups.isFlat(g, positions));
  }
  const double stiffness = totalStiffness(system);
  result.rms_strain = stiffness > 0 ? std::sqrt(2 * result.energy_after / stiffness) : 0;
}

}  // namespace spherical_springs::core
