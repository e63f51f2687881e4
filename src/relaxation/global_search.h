// The lowest of several minima of the energy.
#pragma once

#include <chrono>
#include <cstdint>
#include <vector>

#include "relaxation/free_groups.h"
#include "spherical_springs/relaxation.h"

namespace spherical_springs::core {

/// One relaxation by `RelaxationMethod::global` under way. Newton's method goes down from the
/// present positions, and from where sweeps (`SpringSweeps`) end that start there or at random
/// places. Where the springs tell a group of particles from its mirror image, each minimum is
/// mirrored and relaxed again as well. Of each group the lowest minimum is kept: of those that are
/// equally low, the one found first.
class GlobalSearch {
 public:
  /// All arguments must outlive the search.
  GlobalSearch(const System& system, const Points& positions, const RelaxationOptions& options);

  /// Searches, once.
  RelaxationResult run();

 private:
  using Clock = std::chrono::steady_clock;

  bool isOver();
  Points start(std::uint32_t number) const;
  bool sweep(std::uint32_t number, Points& positions);
  RelaxationResult descend(const Points& from, double done, double share);
  double consider(const RelaxationResult& found);
  bool show(const RelaxationResult& best, double fraction);
  RelaxationResult finished(std::uint32_t tried);

  const System& system_;
  const Points& start_;
  const RelaxationOptions& options_;
  const FreeGroups groups_;
  const Clock::time_point begin_ = Clock::now();
  RelaxationResult best_;
  Eigen::VectorXd energies_;   // of the groups in `best_`
  Eigen::VectorXd rounding_;   // differences of these that say nothing
  std::vector<double> found_;  // energies of all groups that each start has come to
  std::uint32_t iterations_ = 0;
  double fraction_ = 0;
  bool cancelled_ = false, late_ = false, improved_ = false;
};

}  // namespace spherical_springs::core
