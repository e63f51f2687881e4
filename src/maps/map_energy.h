// The energy that is minimised over maps of a mesh to the sphere.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/checkpoint.h"
#include "linear/block_matrix.h"
#include "maps/face_energy.h"

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
  double valueAfter(const Eigen::VectorXd& step) const;
  void move(const Eigen::VectorXd& step);
  double valueHere() const { return valueAt(points_); }  ///< without `evaluate`

  /// Moves each vertex by a Newton step of its own that lowers the energy, those before it being
  /// where they are now (Gauss and Seidel). Cures what a few vertices can cure among themselves,
  /// which would cut the steps of all.
  void sweep();

  /// Value, gradient and Hessian here.
  void evaluate(FaceHessian hessian);
  double value() const { return value_; }
  const Eigen::VectorXd& gradient() const { return gradient_; }
  const Hessian& hessian() const { return hessian_; }
  const std::vector<core::TangentFrame>& frames() const { return frames_; }

  /// Sum over the faces of each vertex of weight / share.
  const Eigen::VectorXd& mass() const { return mass_; }

  /// Standard deviation of log (area / share).
  double spread() const;

 private:
  Eigen::ArrayXd areas(const std::vector<Vector3>& points) const;
  double valueAt(const std::vector<Vector3>& points) const;
  FaceEnergy faceEnergy(Eigen::Index face) const {
    return {shares_[face], weights_[face], shape_, cost_};
  }
  FaceEnergy::Corners corners(Eigen::Index face) const;
  FaceEnergy::Terms terms(Eigen::Index face, FaceHessian hessian) const;
  Eigen::Vector2d ownStep(std::size_t n) const;
  double ownValue(std::size_t n, const Vector3& point) const;
  void moveAlone(std::size_t n);
  void moveEachAlone();
  void put(std::vector<Vector3> points);
  std::vector<Vector3> moved(const Eigen::VectorXd& step) const;

  int threads_;
  core::Checkpoint checkpoint_;
  std::int32_t free_;
  double area_ = 0;  // of all faces together
  double shape_ = 0;
  AreaCost cost_ = AreaCost::barrier;
  std::vector<std::uint32_t> vertices_;  // of the mesh, by number here
  Faces faces_;                          // of numbers
  Eigen::VectorXd shares_, weights_, mass_;
  core::BlockPattern pattern_;
  core::BlockOrder order_;                             // of sweeps
  std::vector<std::uint32_t> first_corner_, corners_;  // 3 face + corner, of each vertex
  std::vector<std::array<std::uint32_t, 3>> places_;   // of each of those with the face's corners
  std::vector<Vector3> points_;
  std::vector<core::TangentFrame> frames_;
  std::vector<FaceEnergy::Terms> terms_;
  double value_ = 0;
  Eigen::VectorXd gradient_;
  Hessian hessian_;
};

}  // namespace spherical_springs::mesh
