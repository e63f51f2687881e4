// Compiled for processors with AVX2 and FMA.
#include "stepping/motion_lanes.h"

namespace spherical_springs::core {

extern const StepKernels kAvx2StepKernels;
const StepKernels kAvx2StepKernels = kKernels;

}  // namespace spherical_springs::core
