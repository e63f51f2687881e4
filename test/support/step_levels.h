// The kernels of a step for each instruction set.
#pragma once

#include <vector>

#include "base/instruction_set.h"
#include "stepping/step_kernels.h"

namespace spherical_springs::core {

extern const StepKernels kPlainStepKernels;
#if defined(__x86_64__)
extern const StepKernels kAvx2StepKernels, kAvx512StepKernels;
#endif

namespace testing {

/// Kernels that this processor can run, from the narrowest to the widest.
inline std::vector<const StepKernels*> stepKernelsHere() {
  std::vector<const StepKernels*> kernels = {&kPlainStepKernels};
#if defined(__x86_64__)
  if (hasAvx2()) kernels.push_back(&kAvx2StepKernels);
  if (hasAvx512()) kernels.push_back(&kAvx512StepKernels);
#endif
  return kernels;
}

}  // namespace testing
}  // namespace spherical_springs::core
