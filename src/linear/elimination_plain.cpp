// Compiled for every processor.
#include "linear/elimination.h"

namespace spherical_springs::core {

extern const EliminationKernels kPlainEliminationKernels;
const EliminationKernels kPlainEliminationKernels = kKernels;

}  // namespace spherical_springs::core
