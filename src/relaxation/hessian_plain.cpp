// For any processor.
#include "relaxation/hessian_lanes.h"

namespace spherical_springs::core {

extern const HessianKernels kPlainHessianKernels;
const HessianKernels kPlainHessianKernels = kKernels;

}  // namespace spherical_springs::core
