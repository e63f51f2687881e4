// The list of kinds of springs. A new kind is a header beside these, its name in the list, and what
// doc/architecture.md names.
#pragma once

#include "spherical_springs/springs/angle.h"
#include "spherical_springs/springs/oriented_angle.h"
#include "spherical_springs/springs/solid_angle.h"

namespace spherical_springs::core {

/// A list of kinds as a type.
template <class... Springs>
struct KindList {};

/// All kinds of springs, in the order in which they are gone through.
using Kinds = KindList<AngleSpring, SolidAngleSpring, OrientedAngleSpring>;

}  // namespace spherical_springs::core
