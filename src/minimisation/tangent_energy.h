// The energy of a system as a function on the tangent planes of its free particles.
#pragma once

#include <Eigen/Sparse>
#include <array>
#include <vector>

#include "spherical_springs/system.h"

namespace spherical_springs::core {

/// Free particle f has the unknowns 2 f and 2 f + 1, its coordinates in a tangent frame of its own.
class TangentEnergy {
 public:
  using Matrix = Eigen::SparseMatrix<double>;

  TangentEnergy(const System& system, const Points& positions);

  /// With inertia / 2 [J/rad^2] times the squared distance of each particle from a target added,
  /// for a step of implicit integration. Targets and positions are to be set before use.
  TangentEnergy(const System& system, Eigen::VectorXd inertia);
  void setTargets(const Points& targets) { targets_ = targets; }

  Eigen::Index unknowns() const { return 2 * static_cast<Eigen::Index>(free_.size()); }
  const Points& positions() const { return positions_; }
  double value() const { return value_; }                        ///< [J]
  const Eigen::VectorXd& gradient() const { return gradient_; }  ///< [N m]

  const Points& torques() const { return workspace_.torques; }  ///< of each particle [N m]

  /// Largest gradient of a free particle, which is its torque [N m].
  double maxTorque() const;

  /// Positions after the free particles have gone along great circles by the tangent vectors
  /// `step` [rad].
  Points moved(const Eigen::VectorXd& step) const;

  /// Takes new positions; value and gradient follow.
  void moveTo(const Points& positions);

  /// Lower triangle of the Hessian at the positions; valid until the next call.
  const Matrix& hessian(Curvature curvature);

  /// For each particle the stiffness of the springs at it, sum of stiffness |gradient|^2, as a
  /// scale for steps; never 0.
  Eigen::VectorXd particleStiffness() const;

  /// The same for each unknown.
  Eigen::VectorXd stiffnessScale() const;

  /// 1 / stiffness of each particle; 0 where pinned.
  Eigen::VectorXd mobility() const;

 private:
  /// Where the columns of a 2 x 2 block begin among the matrix's values; -1: not stored.
  using Block = std::array<int, 2>;

  void findFree();
  void addInertia();
  void addInertiaHessian(Curvature curvature);
  void buildPattern();
  Block block(Eigen::Index row, Eigen::Index column) const;
  void add(const Block& block, bool diagonal, const Eigen::Matrix2d& values);

  const System& system_;
  std::vector<Eigen::Index> free_;     // particle of each free one
  std::vector<Eigen::Index> unknown_;  // free index of each particle, or -1
  Eigen::VectorXd inertia_;            // none in a relaxation
  Points targets_;
  Points positions_;
  std::vector<TangentFrame> frames_;
  System::Workspace workspace_;
  double value_ = 0;
  Eigen::VectorXd gradient_;
  Matrix hessian_;
  // Of the diagonal, and of each pair of ends of each spring, in the order of use.
  std::vector<Block> diagonal_blocks_, blocks_;
};

}  // namespace spherical_springs::core
