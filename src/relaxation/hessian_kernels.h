// The springs of most scenes, several at a time.
#pragma once

#include <cstddef>
#include <cstdint>

namespace spherical_springs::core {

/// A field of each of many structs that lie side by side.
template <class Value>
struct FieldOf {
  const void* first;
  std::size_t stride;  ///< [bytes]

  /// Always inlined, as this header is compiled for several instruction sets.
  [[gnu::always_inline]] inline const Value& operator[](std::size_t i) const {
    return *reinterpret_cast<const Value*>(static_cast<const char*>(first) + i * stride);
  }
};

/// Arrays of springs that join N particles, for kernels to read.
template <std::size_t N>
struct SpringFields {
  using Ends = std::uint32_t[N];
  using Places = std::uint32_t[N * N];

  FieldOf<Ends> particles;
  FieldOf<double> rest, stiffness;
  FieldOf<Places> places;  ///< among the Hessian's blocks, of each pair of ends; or kNotStored
};

/// Arrays of particles for kernels to read, and of gradient and Hessian to add to.
struct HessianArrays {
  static constexpr std::uint32_t kNotStored = ~0u;

  const double* places;      ///< kPlaceSize a particle: tangent vectors x, y, its unit vector
  std::uint32_t free_count;  ///< particles below it have a gradient
  double* gradient;          ///< 2 a free particle
  double* hessian;           ///< 4 a block, by columns
  bool definite;             ///< whether only a definite part of a triangle's Hessian is wanted
  double least_curvature;    ///< across an arc, of its stiffness; what is lower counts as none
};

/// Add energy, gradient and Hessian of the springs from `begin` to `end`, as `tangentCondition` has
/// them, but for the `left_out`: those outside the range of angles of the kernel, and the last ones
/// that do not fill its lanes.
/// @return the energy.
template <std::size_t N>
using HessianKernel = double (*)(const SpringFields<N>& springs, std::uint32_t begin,
                                 std::uint32_t end, const HessianArrays& arrays,
                                 std::uint32_t* left_out, std::uint32_t& left_out_count);

struct HessianKernels {
  HessianKernel<2> angle_springs;
  HessianKernel<3> solid_angle_springs;
};

/// The kernels for the widest instructions that this processor has.
const HessianKernels& hessianKernels();

}  // namespace spherical_springs::core
