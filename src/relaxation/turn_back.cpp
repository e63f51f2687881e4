#include "relaxation/turn_back.h"

#include <algorithm>
#include <utility>

#include "relaxation/descent.h"
#include "system/alignment.h"

namespace spherical_springs::core {

void turnBack(const System& system, const Points& start, const std::vector<bool>& calm,
              RelaxationResult& result) {
  constexpr double kShare = 1e-6;  // of the drop of the energy
  Points turned = aligned(system, start, result.positions, calm);
  const double before = system.potential(start).total();
  const double reached = system.potential(result.positions).total();
  const double after_turn = system.potential(turned).total();
  const double allowed = std::max(kEnergyRounding * reached, kShare * (before - reached));
  const bool turns = after_turn - reached <= allowed;
  if (turns) result.positions = std::move(turned);
  result.energy_before = before;
  result.energy_after = turns ? after_turn : reached;
}

}  // namespace spherical_springs::core
