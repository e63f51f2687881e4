// What is minimised over maps of a mesh to the sphere.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "../minimisation/block_matrix.h"
#include "spherical_springs/mesh/triangle_mesh.h"
#include "spherical_springs/springs/condition.h"

namespace spherical_springs::mesh {

/// The second derivatives of each face: the exact ones; a positive semidefinite part of them; or
/// those that areas have where they are linear (Gauss and Newton), which serve where the areas are
/// nearly right.
enum class FaceHessian { exact, definite, gauss_newton };

/// Over all faces, with r = area / share,
///   (r + 1/r - 2) / 2
///     + shape (tan^2(area / 4) + sum over edges of tan^2(edge / 2) / sqrt 3) / share,
/// which is infinite at a fold, at a face of half of the sphere and at an edge of length pi.
/// Unknown 2 n and 2 n + 1 are coordinates in a tangent frame of the n-th vertex, in an order of
/// its own.
class MapEnergy {
 public:
  using Hessian = core::Blocks<double, 2>;

  /// `points`: about where vertices are, for their order.
  MapEnergy(const Faces& faces, const Eigen::VectorXd& shares, const Points& points, int threads);

  const core::BlockPattern& pattern() const { return pattern_; }
  Eigen::Index faceCount() const { return faces_.cols(); }

  void setShape(double shape) { shape_ = shape; }

  /// Puts vertices somewhere; `evaluate` is to follow.
  void place(const Points& points);
  Points points() const;  ///< in the order of the mesh

  /// The energy that vertices would have after a step along their tangent planes; infinite where
  /// faces would not cover the sphere once.
  double valueAfter(const Eigen::VectorXd& step) const;
  void move(const Eigen::VectorXd& step);

  /// Value, gradient and Hessian here.
  void evaluate(FaceHessian hessian);
  double value() const { return value_; }
  const Eigen::VectorXd& gradient() const { return gradient_; }
  const Hessian& hessian() const { return hessian_; }
  const std::vector<core::TangentFrame>& frames() const { return frames_; }

  /// Sum over the faces of each vertex of 1 / share.
  const Eigen::VectorXd& mass() const { return mass_; }

  /// Standard deviation of log (area / share).
  double spread() const;

 private:
  struct FaceTerms {
    double value;
    Eigen::Matrix<double, 6, 1> gradient;
    Eigen::Matrix<double, 6, 6> hessian;
  };
  double valueAt(const std::vector<Vector3>& points) const;
  FaceTerms termsOf(Eigen::Index face, FaceHessian hessian) const;
  std::vector<Vector3> moved(const Eigen::VectorXd& step) const;

  int threads_;
  double shape_ = 0;
  std::vector<std::uint32_t> vertices_;  // of the mesh, by number here
  Faces faces_;                          // of numbers
  Eigen::VectorXd shares_, mass_;
  core::BlockPattern pattern_;
  std::vector<std::uint32_t> first_corner_, corners_;  // 3 face + corner, of each vertex
  std::vector<std::array<std::uint32_t, 3>> places_;   // of each of those with the face's corners
  std::vector<Vector3> points_;
  std::vector<core::TangentFrame> frames_;
  std::vector<FaceTerms> terms_;
  double value_ = 0;
  Eigen::VectorXd gradient_;
  Hessian hessian_;
};

}  // namespace spherical_springs::mesh
