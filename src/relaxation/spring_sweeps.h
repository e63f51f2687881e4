// Descent by one spring at a time, which passes over the shallow minima of a network.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "spherical_springs/system.h"

namespace spherical_springs::core {

/// Sweeps over all springs in random order. Each spring in turn moves its free particles, the less
/// the heavier they are, so that its condition loses a share of its value: min(1, stiffness *
/// eta), where eta falls from sweep to sweep. With angle springs between all pairs this is
/// spherical multidimensional scaling by stochastic gradient descent (J. Miller, V. Huroyan, S.
/// Kobourov, Graph Drawing 2022), with the schedule of J. X. Zheng, S. Pawar, D. F. M. Goodman,
/// IEEE Trans. Vis. Comput. Graph. 25 (2019).
class SpringSweeps {
 public:
  static constexpr int kCount = 60;  ///< sweeps of one descent

  /// `system` must live longer. The order of the springs depends on `seed` alone.
  SpringSweeps(const System& system, std::uint64_t seed);

  /// One sweep, the first of which is number 0.
  void sweep(int number, Points& positions);

 private:
  struct Run {
    std::uint32_t kind, first, end;  ///< the number of the kind; indices of its springs
  };

  std::uint32_t below(std::size_t bound);
  template <class Item>
  void shuffle(Item* items, std::size_t count);
  template <class Spring>
  void satisfy(const Spring& spring, double eta, Points& positions) const;

  const Values& inverse_masses_;
  std::uint64_t state_;
  SpringLists springs_;    // in random order, so that memory is read in runs
  std::vector<Run> runs_;  // that are gone through in another order each time
  double first_eta_, last_eta_;
};

}  // namespace spherical_springs::core
