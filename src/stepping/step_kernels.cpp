#include "stepping/step_kernels.h"

#include "base/instruction_set.h"

namespace spherical_springs::core {

extern const StepKernels kPlainStepKernels;
#ifdef SPHERICAL_SPRINGS_X86
extern const StepKernels kAvx2StepKernels, kAvx512StepKernels;
#endif

const StepKernels& stepKernels() {
#ifdef SPHERICAL_SPRINGS_X86
  if (hasAvx512()) return kAvx512StepKernels;
  if (hasAvx2()) return kAvx2StepKernels;
#endif
  return kPlainStepKernels;
}

}  // namespace spherical_springs::core
