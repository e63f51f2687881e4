// The list of kinds with one more, for which nothing but its formula exists.
#pragma once

#include "spherical_springs/springs/angle.h"
#include "spherical_springs/springs/oriented_angle.h"
#include "spherical_springs/springs/solid_angle.h"
#include "two_cosines.h"

namespace spherical_springs::core {

/// A list of kinds as a type.
template <class... Springs>
struct KindList {};

/// All kinds of springs, in the order in which they are gone through.
using Kinds = KindList<AngleSpring, TwoCosinesSpring, SolidAngleSpring, OrientedAngleSpring>;

}  // namespace spherical_springs::core
