#pragma once

#include "geometry/place_size.h"
#include "spherical_springs/sphere.h"

namespace spherical_springs::core {

/// A point of the sphere and the frame of its tangent plane, padded to the size that kernels take.
struct alignas(2 * sizeof(double)) TangentPlace {
  TangentFrame frame;
  Vector3 point;
};

static_assert(sizeof(TangentPlace) == kPlaceSize * sizeof(double));

}  // namespace spherical_springs::core
