// For any processor.
#include "stepping/motion_lanes.h"

namespace spherical_springs::core {

extern const StepKernels kPlainStepKernels;
const StepKernels kPlainStepKernels = kKernels;

}  // namespace spherical_springs::core
