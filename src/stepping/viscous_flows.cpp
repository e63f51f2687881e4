#include "stepping/viscous_flows.h"

#include <algorithm>
#include <utility>

namespace spherical_springs::core {

void ViscousFlows::prepare(double duration, const Damping& damping, const Layout& layout) {
  for (const ViscousFlow& known : known_) {
    if (known.duration == duration) return;
  }
  ViscousFlow made{duration, {}, {}, {}};
  const std::size_t count = layout.slotCount();
  made.decay.assign(count, 1);
  made.gain.assign(count, 0);
  for (auto& taken : made.taken) taken.assign(count, 0);
  for (const Patch& patch : layout.patches()) {
    for (std::uint32_t i = 0; i < patch.particle_count; ++i) {
      const auto flow = damping.viscousFlow(layout.order()[patch.first_place + i], duration);
      const std::uint32_t slot = patch.first_slot + i;
      made.decay[slot] = flow.decay;
      made.gain[slot] = flow.gain;
      for (int k = 0; k < 3; ++k) made.taken[k][slot] = flow.taken[k];
    }
  }
  known_.push_back(std::move(made));
}

const ViscousFlow& ViscousFlows::over(double duration) const {
  return *std::find_if(known_.begin(), known_.end(),
                       [&](const ViscousFlow& known) { return known.duration == duration; });
}

}  // namespace spherical_springs::core
