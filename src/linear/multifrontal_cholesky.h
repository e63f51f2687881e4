#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "linear/nested_dissection.h"
#include "linear/preconditioner.h"

namespace spherical_springs::core {

/// The exact inverse, by a Cholesky factorisation in dense fronts along a nested dissection (J.
/// Liu, SIAM Review 34, 1992): for meshes, some n^1.5 multiplications.
class MultifrontalCholesky : public Preconditioner<double> {
 public:
  /// `pattern` must live longer. What `checkpoint` throws ends `refresh` or `apply`; `refresh` may
  /// follow.
  MultifrontalCholesky(const BlockPattern& pattern, int threads, Checkpoint checkpoint = passAll);

  /// Multiplications of one factorisation, about.
  double work() const;

  bool refresh(const Blocks<double, 2>& values) override;
  void apply(const VectorOf<double>& residual, VectorOf<double>& correction) override;

 private:
  using Part = NestedDissection::Part;

  /// A part's rows of the factor: of its own unknowns, over those of its boundary.
  struct Front {
    Eigen::MatrixXd own, below;
    Eigen::MatrixXd rest;  ///< what elimination leaves to the parent; empty once that has it
    bool definite = false;
  };

  void factorise(std::size_t part, const Blocks<double, 2>& values);
  void assemble(const Part& part, const Blocks<double, 2>& values, Front& front) const;
  void addChild(const Part& part, const Part& child, Front& front, Front& below) const;
  static std::size_t positionOf(const Part& part, std::uint32_t place);

  const BlockPattern& pattern_;
  int threads_;
  Checkpoint checkpoint_;
  NestedDissection dissection_;
  // Subtrees that threads may share, as ranges of parts; what is above them comes last.
  std::vector<std::pair<std::size_t, std::size_t>> subtrees_;
  std::vector<std::size_t> above_;
  std::vector<Front> fronts_;
};

}  // namespace spherical_springs::core
