// The kernels of a step for each instruction set.
#pragma once

#include <vector>

#include "kernels/step_kernels.h"

namespace spherical_springs::core {

extern const StepKernels kPlainStepKernels;
#if defined(__x86_64__)
extern const StepKernels kAvx2StepKernels, kAvx512StepKernels;
#endif

namespace testing {

/// Those that this processor can run, from the narrowest to the widest.
inline std::vector<const StepKernels*> stepKernelsHere() {
  std::vector<const StepKernels*> kernels = {&kPlainStepKernels};
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    kernels.push_back(&kAvx2StepKernels);
  }
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")) {
    kernels.push_back(&kAvx512StepKernels);
  }
#endif
  return kernels;
}

}  // namespace testing
}  // namespace spherical_springs::core
