// The energy that is minimised over maps of a mesh to the sphere.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/checkpoint.h"
#include "geometry/tangent_place.h"
#include "linear/block_matrix.h"
#include "maps/face_energy.h"
#include "maps/face_kernels.h"

namespace spherical_springs::mesh {

/// How much each face counts: all alike, as in the spread that is wanted; or by the square root of
/// its share, so that tiny faces do not rule before the large ones are about right.
enum class FaceWeights { equal, root_of_share };

/// The sum over the faces of their `FaceEnergy`; infinite where their areas do not sum to those of
/// the sphere, or of the part of it that they had, as where they cover it twice. Unknown 2 n and
/// 2 n + 1 are coordinates in a tangent frame of the n-th vertex that moves, in an order of its
/// own.
class MapEnergy {
 public:
  using Hessian = core::Blocks<double, 2>;

  /// `points`: about where vertices are, for their order. What `checkpoint` throws, or want of
  /// memory, ends `evaluate` or `sweep`, with vertices where they were.
  MapEnergy(const Faces& faces, const Eigen::VectorXd& shares, const Points& points, int threads,
            const core::Checkpoint& checkpoint = core::passAll);

  /// The energy of a patch of a map: the first `free` points, whose faces must all be in `faces`,
  /// move, and the others stay.
  MapEnergy(const Faces& faces, const Eigen::VectorXd& shares, const Points& points,
            std::int32_t free, int threads, const core::Checkpoint& checkpoint = core::passAll);

  const core::BlockPattern& pattern() const { return pattern_; }
  Eigen::Index faceCount() const { return faces_.cols(); }

  void setShape(double shape) { shape_ = shape; }
  void setCost(AreaCost cost) { cost_ = cost; }
  void setWeights(FaceWeights weights);

  /// Puts vertices somewhere; `evaluate` is to follow.
  void place(const Points& points);
  Points points() const;                   ///< in the order of the mesh
  void writePoints(Points& points) const;  ///< over others; takes no memory

  /// The energy that vertices would have after a step along their tangent planes.
  double valueAfter(const Eigen::VectorXd& step);
  void move(const Eigen::VectorXd& step);
  double valueHere() const { return valueAt(rowsHere()); }  ///< without `evaluate`

  /// Moves each vertex by a Newton step of its own that lowers the energy, those before it being
  /// where they are now (Gauss and Seidel). Cures what a few vertices can cure among themselves,
  /// which would cut the steps of all.
  void sweep();

  /// Value, gradient and Hessian here.
  void evaluate(FaceHessian hessian);
  double value() const { return value_; }
  const Eigen::VectorXd& gradient() const { return gradient_; }
  const Hessian& hessian() const { return hessian_; }

  /// Sum over the faces of each vertex of weight / share.
  const Eigen::VectorXd& mass() const { return mass_; }

  /// Standard deviation of log (area / share).
  double spread() const;

 private:
  static constexpr std::uint32_t kNoBlock = ~0u;  // of a vertex that stays

  /// A unit vector, padded for kernels.
  struct PaddedPoint {
    Vector3 point;
    double padding;
  };

  PointRows rowsHere() const { return {places_.front().point.data(), core::kPlaceSize}; }
  Eigen::ArrayXd areas() const;
  double valueAt(const PointRows& points) const;
  Vector3 moved(std::size_t n, const Eigen::VectorXd& step) const;
  void layOutCorners();
  FaceLists faceLists() const;
  RingLists ringLists() const;
  FaceEnergy faceEnergy(Eigen::Index face) const {
    return {shares_[face], weights_[face], shape_, cost_};
  }
  FaceEnergy::Corners corners(Eigen::Index face, const PointRows& points) const;
  FaceEnergy::Terms terms(Eigen::Index face, FaceHessian hessian) const;
  double evaluateFaces(std::uint32_t begin, std::uint32_t end, FaceHessian hessian);
  void gatherRow(std::size_t n);
  RingTerms ownTerms(std::size_t n) const;
  double ownValue(std::size_t n, const Vector3& point) const;
  void moveAlone(std::size_t n);
  void moveEachAlone();

  const FaceKernels& kernels_ = faceKernels();
  int threads_;
  core::Checkpoint checkpoint_;
  std::int32_t free_;
  double area_ = 0;  // of all faces together
  double shape_ = 0;
  AreaCost cost_ = AreaCost::barrier;
  std::vector<std::uint32_t> vertices_;  // of the mesh, by number here
  Faces faces_;                          // of numbers
  Eigen::VectorXd shares_, mass_;
  std::vector<double> weights_, over_shares_;  // one a face, with padding
  core::BlockPattern pattern_;
  core::BlockOrder order_;                             // of sweeps
  std::vector<std::uint32_t> first_corner_, corners_;  // 3 face + corner, of each vertex
  std::vector<std::array<std::uint32_t, 3>> blocks_;   // of each of those with the face's corners
  std::vector<std::int32_t> next_, last_;  // corners of the face, of each corner of a vertex
  std::vector<double> corner_weights_, corner_over_shares_;  // with padding
  std::vector<core::TangentPlace> places_;
  std::vector<PaddedPoint> trial_;
  std::vector<FaceTerms> terms_;
  double value_ = 0;
  Eigen::VectorXd gradient_;
  Hessian hessian_;
};

}  // namespace spherical_springs::mesh
