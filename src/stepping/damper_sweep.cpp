#include "damper_sweep.h"

#include <array>
#include <cmath>

namespace spherical_springs::core {
namespace {

/// Of all ends of a spring.
template <int kEnds>
std::array<Vector3, kEnds> gradientsAt(const GradientGroup<kEnds>& group, std::uint32_t lane) {
  std::array<Vector3, kEnds> gradients;
  gradients[kEnds - 1].setZero();
  for (int i = 0; i < kEnds - 1; ++i) {
    for (int k = 0; k < 3; ++k) gradients[i][k] = group.of[i][k][lane];
    gradients[kEnds - 1] -= gradients[i];
  }
  return gradients;
}

double squared(double x) { return x * x; }

}  // namespace

template <class Spring>
std::size_t DamperSweep::flowIndex(std::uint32_t group, std::uint32_t lane) const {
  return (group * kGroup + lane) * (own_ ? Spring::kParticles : 1);
}

void DamperSweep::makeRoom() {
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    const auto groups = static_cast<std::uint32_t>(dampers_.groups().get<Spring>().size());
    flows_.get<Spring>().resize(flowIndex<Spring>(groups, 0));
  });
}

/// `mobility`: of the gradients times the root of the coefficient.
DamperSweep::Flow DamperSweep::flowOf(double mobility, double duration) {
  if (mobility == 0) return {0, 0};
  const double growth = std::expm1(-mobility * duration);
  return {growth / mobility, -0.5 * growth * (growth + 2) / mobility};
}

void DamperSweep::takeFlows(std::size_t patch, double duration) {
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    constexpr int kEnds = Spring::kParticles;
    const GroupRange& range = dampers_.shares()[patch].get<Spring>().groups;
    for (std::uint32_t i = range.begin * kGroup; i < range.end * kGroup; ++i) {
      const std::uint32_t group = i / kGroup, lane = i % kGroup;
      const auto& dampers = dampers_.groups().get<Spring>()[group];
      const auto gradients = gradientsAt<kEnds>(gradients_.get<Spring>()[group], lane);
      Flow* const flows = &flows_.get<Spring>()[flowIndex<Spring>(group, lane)];
      double sum = 0;
      for (int e = 0; e < kEnds; ++e) {
        const double mobility =
            gradients[e].squaredNorm() * squared(dampers.root_mobility[e][lane]);
        if (own_) flows[e] = flowOf(mobility, duration);
        sum += mobility;
      }
      if (!own_) flows[0] = flowOf(sum, duration);
    }
  });
}

/// @return the energy that it took out [J].
template <class Spring>
double DamperSweep::damp(std::uint32_t group, std::uint32_t lane, Row* const* ends) const {
  constexpr int kEnds = Spring::kParticles;
  const auto& dampers = dampers_.groups().get<Spring>()[group];
  const auto gradients = gradientsAt<kEnds>(gradients_.get<Spring>()[group], lane);
  const Flow* const flows = &flows_.get<Spring>()[flowIndex<Spring>(group, lane)];
  const auto velocity = [&](int e) { return Eigen::Map<Vector3>(ends[e]->values); };
  const auto push = [&](int e, double momentum) {
    velocity(e) += momentum * squared(dampers.root_mobility[e][lane]) * gradients[e];
  };
  double rates[kEnds], sum = 0, taken = 0;
  for (int e = 0; e < kEnds; ++e) sum += rates[e] = gradients[e].dot(velocity(e));
  if (!own_) {
    for (int e = 0; e < kEnds; ++e) push(e, flows[0].impulse * sum);
    return flows[0].energy * squared(sum);
  }
  for (int e = 0; e < kEnds; ++e) {
    push(e, flows[e].impulse * rates[e]);
    taken += flows[e].energy * squared(rates[e]);
  }
  return taken;
}

template <class Spring>
double DamperSweep::dampInner(std::uint32_t group, std::uint32_t lane, Row* velocities) const {
  const auto& dampers = dampers_.groups().get<Spring>()[group];
  Row* ends[Spring::kParticles];
  for (std::size_t e = 0; e < Spring::kParticles; ++e) {
    ends[e] = velocities + dampers.ends[e][lane] / kRowLength;
  }
  return damp<Spring>(group, lane, ends);
}

double DamperSweep::innerForward(std::size_t patch, Row* velocities) const {
  double taken = 0;
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    const auto& share = dampers_.shares()[patch].get<Spring>();
    for (std::uint32_t group = share.groups.begin; group < share.groups.end; ++group) {
      for (std::uint32_t lane = 0; lane < kGroup; ++lane) {
        if (share.groups.elementAt(group, lane) >= share.inner) break;
        taken += dampInner<Spring>(group, lane, velocities);
      }
    }
  });
  return taken;
}

double DamperSweep::innerBackward(std::size_t patch, Row* velocities) const {
  double taken = 0;
  forEachKindBackward([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    const auto& share = dampers_.shares()[patch].get<Spring>();
    for (std::uint32_t group = share.groups.end; group-- > share.groups.begin;) {
      for (std::uint32_t lane = kGroup; lane-- > 0;) {
        if (share.groups.elementAt(group, lane) >= share.inner) continue;
        taken += dampInner<Spring>(group, lane, velocities);
      }
    }
  });
  return taken;
}

template <class Spring>
double DamperSweep::dampShared(const SharedDamper& damper, Row* velocities) const {
  Row* ends[Spring::kParticles];
  for (std::size_t e = 0; e < Spring::kParticles; ++e) ends[e] = velocities + damper.rows[e];
  return damp<Spring>(damper.group, damper.lane, ends);
}

double DamperSweep::shared(Row* velocities) const {
  double taken = 0;
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    for (const SharedDamper& damper : dampers_.shared().get<Spring>()) {
      taken += dampShared<Spring>(damper, velocities);
    }
  });
  forEachKindBackward([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    const auto& list = dampers_.shared().get<Spring>();
    for (auto damper = list.rbegin(); damper != list.rend(); ++damper) {
      taken += dampShared<Spring>(*damper, velocities);
    }
  });
  return taken;
}

}  // namespace spherical_springs::core
