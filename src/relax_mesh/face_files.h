// Files of numbers, one line or more a face.
#pragma once

#include <istream>
#include <ostream>

#include "spherical_springs/mesh/distortion.h"

namespace spherical_springs::mesh {

/// `faces` positive numbers, parted by blanks or line ends.
/// @throw std::invalid_argument, which names the first number at fault, counted from 0, unless
/// there are as many, all finite and above 0.
Eigen::VectorXd readDensities(std::istream& in, Eigen::Index faces);

/// Comma-separated values under a line of names: shares, areas and what became of the angles.
void writeMetrics(std::ostream& out, const Eigen::VectorXd& shares, const FaceDistortion& faces);

}  // namespace spherical_springs::mesh
