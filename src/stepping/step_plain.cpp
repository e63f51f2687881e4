// For any processor.
#include "stepping/damper_layout.h"
#include "stepping/motion_lanes.h"

namespace spherical_springs::core {

extern const StepKernels kPlainStepKernels;
const StepKernels kPlainStepKernels = kKernels;

namespace {

template <class Spring>
std::uint32_t leaveAllGradients(const PlainDampers<Spring>*, std::uint32_t group_count,
                                const double*, GradientsOf<PlainDampers<Spring>>*,
                                std::uint32_t* hard) {
  const std::uint32_t count = group_count * static_cast<std::uint32_t>(kGroup);
  for (std::uint32_t s = 0; s < count; ++s) hard[s] = s;
  return count;
}

PerKind<PlainDamperKernels> plainKernels() {
  PerKind<PlainDamperKernels> kernels;
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    if constexpr (!kHasStepKernels<Spring>) {
      using Dampers = PlainDampers<Spring>;
      kernels.get<Spring>().all = {leaveAllGradients<Spring>, addBounds<Dampers>, addRates<Dampers>,
                                   dampAll<Dampers, false>, dampAll<Dampers, true>};
    }
  });
  return kernels;
}

}  // namespace

const PerKind<PlainDamperKernels>& plainDamperKernels() {
  static const PerKind<PlainDamperKernels> kernels = plainKernels();
  return kernels;
}

}  // namespace spherical_springs::core
