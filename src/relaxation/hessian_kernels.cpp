#include "relaxation/hessian_kernels.h"

#include "base/instruction_set.h"

namespace spherical_springs::core {

extern const HessianKernels kPlainHessianKernels;
#ifdef SPHERICAL_SPRINGS_X86
extern const HessianKernels kAvx2HessianKernels, kAvx512HessianKernels;
#endif

const HessianKernels& hessianKernels() {
#ifdef SPHERICAL_SPRINGS_X86
  if (hasAvx512()) return kAvx512HessianKernels;
  if (hasAvx2()) return kAvx2HessianKernels;
#endif
  return kPlainHessianKernels;
}

}  // namespace spherical_springs::core
