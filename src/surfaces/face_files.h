// Files of numbers, one line or more a face.
#pragma once

#include <istream>
#include <ostream>

#include "base/checkpoint.h"
#include "spherical_springs/maps/distortion.h"

namespace spherical_springs::mesh {

/// Reads `faces` positive numbers, parted by blanks or line ends.
/// @throw std::invalid_argument, which names the first number at fault, counted from 0, unless
/// there are as many, all finite and above 0.
Values readDensities(std::istream& in, Eigen::Index faces,
                     const core::Checkpoint& checkpoint = core::passAll);

/// Writes comma-separated values under a line of names: shares, areas, changes of the angles.
void writeMetrics(std::ostream& out, const ValuesRef& shares, const FaceDistortion& faces,
                  const core::Checkpoint& checkpoint = core::passAll);

}  // namespace spherical_springs::mesh
