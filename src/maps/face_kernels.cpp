#include "maps/face_kernels.h"

#include "base/instruction_set.h"

namespace spherical_springs::mesh {

extern const FaceKernels kPlainFaceKernels;
#ifdef SPHERICAL_SPRINGS_X86
extern const FaceKernels kAvx2FaceKernels, kAvx512FaceKernels;
#endif

const FaceKernels& faceKernels() {
#ifdef SPHERICAL_SPRINGS_X86
  if (core::hasAvx512()) return kAvx512FaceKernels;
  if (core::hasAvx2()) return kAvx2FaceKernels;
#endif
  return kPlainFaceKernels;
}

}  // namespace spherical_springs::mesh
