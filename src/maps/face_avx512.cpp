// Compiled for processors with AVX-512.
#include "maps/face_lanes.h"

namespace spherical_springs::mesh {

extern const FaceKernels kAvx512FaceKernels;
const FaceKernels kAvx512FaceKernels = kKernels;

}  // namespace spherical_springs::mesh
