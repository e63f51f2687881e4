// Compiled for processors with AVX-512.
#include "relaxation/hessian_lanes.h"

namespace spherical_springs::core {

extern const HessianKernels kAvx512HessianKernels;
const HessianKernels kAvx512HessianKernels = kKernels;

}  // namespace spherical_springs::core
