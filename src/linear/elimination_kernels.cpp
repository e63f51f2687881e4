#include "linear/elimination_kernels.h"

#include "base/instruction_set.h"

namespace spherical_springs::core {

extern const EliminationKernels kPlainEliminationKernels;
#ifdef SPHERICAL_SPRINGS_X86
extern const EliminationKernels kAvx2EliminationKernels, kAvx512EliminationKernels;
#endif

const EliminationKernels& eliminationKernels() {
#ifdef SPHERICAL_SPRINGS_X86
  if (hasAvx512()) return kAvx512EliminationKernels;
  if (hasAvx2()) return kAvx2EliminationKernels;
#endif
  return kPlainEliminationKernels;
}

}  // namespace spherical_springs::core
