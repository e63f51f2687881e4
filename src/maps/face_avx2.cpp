// Compiled for processors with AVX2 and FMA.
#include "maps/face_lanes.h"

namespace spherical_springs::mesh {

extern const FaceKernels kAvx2FaceKernels;
const FaceKernels kAvx2FaceKernels = kKernels;

}  // namespace spherical_springs::mesh
