#include "step_kernels.h"

namespace spherical_springs::core {

extern const StepKernels kPlainStepKernels;
#ifdef SPHERICAL_SPRINGS_X86
extern const StepKernels kAvx2StepKernels, kAvx512StepKernels;
#endif

const StepKernels& stepKernels() {
#ifdef SPHERICAL_SPRINGS_X86
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")) {
    return kAvx512StepKernels;
  }
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return kAvx2StepKernels;
#endif
  return kPlainStepKernels;
}

}  // namespace spherical_springs::core
