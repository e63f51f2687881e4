// Compiled for processors with AVX2 and FMA.
// Under a name of its own, as the linker would take functions of any instruction set for all.
#define Eigen EigenForAvx2
#include "linear/elimination.h"

namespace spherical_springs::core {

extern const EliminationKernels kAvx2EliminationKernels;
const EliminationKernels kAvx2EliminationKernels = kKernels;

}  // namespace spherical_springs::core
