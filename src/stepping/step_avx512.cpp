// Compiled for processors with AVX-512.
#include "stepping/motion_lanes.h"

namespace spherical_springs::core {

extern const StepKernels kAvx512StepKernels;
const StepKernels kAvx512StepKernels = kKernels;

}  // namespace spherical_springs::core
