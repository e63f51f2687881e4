#include "hessian_kernels.h"

namespace spherical_springs::core {

extern const HessianKernels kPlainHessianKernels;
#ifdef SPHERICAL_SPRINGS_X86
extern const HessianKernels kAvx2HessianKernels, kAvx512HessianKernels;
#endif

const HessianKernels& hessianKernels() {
#ifdef SPHERICAL_SPRINGS_X86
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")) {
    return kAvx512HessianKernels;
  }
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return kAvx2HessianKernels;
#endif
  return kPlainHessianKernels;
}

}  // namespace spherical_springs::core
