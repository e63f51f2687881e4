// For any processor.
#include "maps/face_lanes.h"

namespace spherical_springs::mesh {

extern const FaceKernels kPlainFaceKernels;
const FaceKernels kPlainFaceKernels = kKernels;

}  // namespace spherical_springs::mesh
