#include "stepping/damper_sweep.h"

#include <array>
#include <cmath>

namespace spherical_springs::core {
namespace {

/// Returns the gradients at all ends of a spring.
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
DamperFlow DamperSweep::flowOf(double mobility, double duration) {
  if (mobility == 0) return {0, 0};
  const double growth = std::expm1(-mobility * duration);
  const double impulse = growth / mobility;
  return {impulse, -0.5 * impulse * (growth + 2)};
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
      DamperFlow* const flows = &flows_.get<Spring>()[flowIndex<Spring>(group, lane)];
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

template <class Spring>
DamperChain<DampersOf<Spring>> DamperSweep::chain(std::size_t patch) const {
  const auto& [groups, inner] = dampers_.shares()[patch].get<Spring>();
  return {dampers_.groups().get<Spring>().data() + groups.begin,
          gradients_.get<Spring>().data() + groups.begin,
          flows_.get<Spring>().data() + flowIndex<Spring>(groups.begin, 0),
          groups.end - groups.begin, inner};
}

double DamperSweep::innerForward(std::size_t patch, Row* velocities) const {
  double taken = 0;
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    const auto& kernels = damperKernels<Spring>(kernels_);
    taken += kernels.forward(chain<Spring>(patch), own_, velocities->values);
  });
  return taken;
}

double DamperSweep::innerBackward(std::size_t patch, Row* velocities) const {
  double taken = 0;
  forEachKindBackward([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    const auto& kernels = damperKernels<Spring>(kernels_);
    taken += kernels.backward(chain<Spring>(patch), own_, velocities->values);
  });
  return taken;
}

/// @return the energy that it took out [J].
template <class Spring>
double DamperSweep::dampShared(const SharedDamper& damper, Row* velocities) const {
  constexpr int kEnds = Spring::kParticles;
  const auto [group, lane, rows] = damper;
  const auto& dampers = dampers_.groups().get<Spring>()[group];
  const auto gradients = gradientsAt<kEnds>(gradients_.get<Spring>()[group], lane);
  const DamperFlow* const flows = &flows_.get<Spring>()[flowIndex<Spring>(group, lane)];
  const auto velocity = [&, &rows = rows](int e) {
    return Eigen::Map<Vector3>(velocities[rows[e]].values);
  };
  const auto push = [&, lane = lane](int e, double momentum) {
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
