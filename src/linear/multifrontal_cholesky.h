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

  /// Successive rows of a boundary that are successive rows of the parent's front as well, either
  /// all among its own unknowns or all among its boundary.
  struct Run {
    std::uint32_t first, end;  ///< rows of the boundary
    std::uint32_t to;          ///< row of the first one in the parent's `own` or `below`
    bool is_own;               ///< whether they lie in the parent's `own`
  };

  /// A block of the matrix that is put into a front.
  struct Entry {
    std::uint32_t place;        ///< among the blocks of the matrix
    std::uint32_t row, column;  ///< in the front; rows of `below` follow those of `own`
  };

  /// A part's rows of the factor: of its own unknowns, over those of its boundary.
  struct Front {
    Eigen::MatrixXd own, below;
    /// The Schur complement that elimination leaves to the parent. Only its lower triangle is
    /// valid; its memory is in `remains_`.
    Eigen::Map<Eigen::MatrixXd> rest{nullptr, 0, 0};
    std::vector<Entry> entries;
    std::vector<Run> runs;  ///< of its boundary among the parent's rows
    Eigen::VectorXd left;   ///< of a right-hand side, for the rows of its boundary
    bool definite = false;
  };

  void layOut(const std::vector<std::size_t>& depths);
  void layOutRests(const std::vector<std::size_t>& numbers, const std::vector<std::size_t>& depths);
  void layOutRestsOfLevels();
  Eigen::Index restSize(std::size_t part) const;
  void putRest(std::size_t part, double* place);
  template <class Visitor>
  void visitUpwards(const Visitor& visit);
  template <class Visitor>
  void visitDownwards(const Visitor& visit);
  template <class Visitor>
  void visitLevel(const std::vector<std::size_t>& level, const Visitor& visit);
  void factorise(std::size_t part, const Blocks<double, 2>& values);
  void forwards(std::size_t part, Eigen::VectorXd& x);
  void backwards(std::size_t part, Eigen::VectorXd& x);
  void layOutEntries(const Part& part, Front& front) const;
  static void assemble(const Blocks<double, 2>& values, Front& front);
  static std::vector<Run> runsOf(const Part& child, const Part& parent);
  static void addChild(Front& front, const Front& child, bool own_columns);
  static std::size_t positionOf(const Part& part, std::uint32_t place);

  const BlockPattern& pattern_;
  int threads_;
  Checkpoint checkpoint_;
  NestedDissection dissection_;
  // Subtrees that threads may share, as ranges of parts; the parts above them come after, level by
  // level from the deepest, here by depth.
  std::vector<std::pair<std::size_t, std::size_t>> subtrees_;
  std::vector<std::vector<std::size_t>> levels_;
  std::vector<Front> fronts_;
  std::vector<Eigen::VectorXd> remains_;  // room of the fronts' rests, used again and again
};

}  // namespace spherical_springs::core
