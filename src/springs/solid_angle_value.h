// The value of a solid-angle spring's condition, from the invariants of its triangle.
#pragma once

#include "spherical_springs/sphere.h"
#include "spherical_springs/springs/solid_angle.h"

namespace spherical_springs::core {

/// Returns what `condition` has as its value [sr].
double conditionValue(const SolidAngleSpring& spring, const Triangle& triangle);

}  // namespace spherical_springs::core
