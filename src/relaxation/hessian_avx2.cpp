// Compiled for processors with AVX2 and FMA.
#include "relaxation/hessian_lanes.h"

namespace spherical_springs::core {

extern const HessianKernels kAvx2HessianKernels;
const HessianKernels kAvx2HessianKernels = kKernels;

}  // namespace spherical_springs::core
