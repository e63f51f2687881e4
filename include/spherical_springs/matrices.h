// Vectors and matrices as programs and the library hand them to each other.
#pragma once

#include <Eigen/Core>
#include <cstddef>

namespace spherical_springs::core {

static_assert(sizeof(Eigen::Index) == sizeof(std::ptrdiff_t),
              "spherical_springs: leave EIGEN_DEFAULT_DENSE_INDEX_TYPE undefined, as its library");

/// A matrix that lies in memory the same way whatever flags (-mavx, -march=native) it is compiled
/// with. Eigen aligns its own types as suits the widest vectors of the target, and frees them
/// accordingly: between two sides with different flags they would be taken for what they are not.
/// Eigen's own convert to these and back, by a copy.
template <class Scalar, int Rows, int Columns>
using Unaligned = Eigen::Matrix<Scalar, Rows, Columns, Eigen::ColMajor | Eigen::DontAlign>;

using Vector2 = Unaligned<double, 2, 1>;              ///< coordinates in a tangent plane
using Vector3 = Eigen::Vector3d;                      ///< of a size that Eigen aligns for no target
using Matrix2 = Unaligned<double, 2, 2>;              ///< by coordinates in tangent planes
using Points = Unaligned<double, 3, Eigen::Dynamic>;  ///< one column a particle
using Values = Unaligned<double, Eigen::Dynamic, 1>;  ///< one entry a particle, or a face

/// `Values`, or any vector or expression of Eigen, to be read; who calls makes and frees it.
using ValuesRef = Eigen::Ref<const Eigen::VectorXd>;

static_assert(sizeof(Vector3) == 3 * sizeof(double) && alignof(Vector3) == alignof(double));

}  // namespace spherical_springs::core
