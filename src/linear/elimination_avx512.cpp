// Compiled for processors with AVX-512.
// Under a name of its own, as the linker would take functions of any instruction set for all.
#define Eigen EigenForAvx512
#include "linear/elimination.h"

namespace spherical_springs::core {

extern const EliminationKernels kAvx512EliminationKernels;
const EliminationKernels kAvx512EliminationKernels = kKernels;

}  // namespace spherical_springs::core
