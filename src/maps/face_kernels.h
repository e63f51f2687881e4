// Energies of the faces of a map, several faces at a time.
#pragma once

#include <cstddef>
#include <cstdint>

#include "maps/face_options.h"

namespace spherical_springs::mesh {

/// Numbers that kernels may read, and do not use, after the last of a list of weights or shares.
inline constexpr std::size_t kLanePadding = 8;

/// Faces for kernels to read; see `FaceEnergy`. Lists end with `kLanePadding` more positive
/// numbers.
struct FaceLists {
  const std::int32_t* corners;  ///< three a face
  const double* over_shares;
  const double* weights;
  double shape;
  AreaCost cost;
};

/// The faces round vertices for kernels to read, those of one vertex side by side.
struct RingLists {
  const std::int32_t *next, *last;  ///< the other corners in the positive sense
  const double* over_shares;
  const double* weights;
  double shape;
  AreaCost cost;
};

/// Unit vectors, `stride` numbers apart; a fourth number after the last one can be read, too.
struct PointRows {
  const double* first;
  std::size_t stride;
};

/// Derivatives of a face by tangent coordinates of its corners; blocks by columns.
struct FaceTerms {
  double gradient[4][2];  ///< the last is none
  double diagonal[3][4];
  double coupling[3][4];  ///< of each corner with the next one
};

/// The part of a vertex in the energy of the faces round it.
struct RingTerms {
  double value;
  double gradient[2];
  double hessian[3];  ///< xx, xy, yy
};

struct FaceSums {
  double energy, area;
};

/// Faces that a kernel leaves out: large ones, for which it would not be accurate.
struct LeftOut {
  std::uint32_t* faces;
  std::uint32_t count;
};

/// Kernels over faces. `places` are `core::TangentPlace`, of `core::kPlaceSize` numbers each.
struct FaceKernels {
  /// Sums over the faces from `begin` to `end`. Energy is infinite where a face is not clearly
  /// positive and the cost is a barrier.
  FaceSums (*sums)(const FaceLists& faces, const PointRows& points, std::uint32_t begin,
                   std::uint32_t end, LeftOut& left_out);
  /// Writes the area of each face.
  void (*areas)(const FaceLists& faces, const PointRows& points, std::uint32_t begin,
                std::uint32_t end, double* areas, LeftOut& left_out);
  /// Writes the terms of each face.
  /// @return the energy.
  double (*terms)(const FaceLists& faces, const double* places, std::uint32_t begin,
                  std::uint32_t end, FaceHessian hessian, FaceTerms* terms, LeftOut& left_out);
  /// Sums the terms of the faces round a vertex.
  /// @return whether no face is large; else there is no result.
  bool (*ring_terms)(const RingLists& ring, const double* places, std::uint32_t begin,
                     std::uint32_t end, const double* place, RingTerms& terms);
  /// Sums the energies of the faces round a vertex if it were at `point`.
  /// @return whether no face is large; else there is no result.
  bool (*ring_value)(const RingLists& ring, const PointRows& points, std::uint32_t begin,
                     std::uint32_t end, const double* point, double& value);
};

/// The kernels for this processor. Results of different instruction sets differ by rounding.
const FaceKernels& faceKernels();

}  // namespace spherical_springs::mesh
