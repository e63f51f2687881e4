#pragma once

#include <Eigen/Core>

namespace spherical_springs::core {

/// The matrix of the cross product: skew(v) w = v x w.
inline Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

}  // namespace spherical_springs::core
