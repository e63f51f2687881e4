// Ways out of the minima in which a map ends.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "maps/map_energy.h"
#include "maps/patch.h"

namespace spherical_springs::mesh {

/// Basin hopping (Wales and Doye, J. Phys. Chem. A 101, 1997) on patches of a map about faces whose
/// areas are wrong. Vertices in the middle are scattered, whatever folds; the patch descends first
/// the squares of the errors of its signed areas, which let folds go, and then the energy, and
/// stays where that is lower, to be scattered from there. What is left of an energy is mostly the
/// matter of a few hundred vertices.
class BasinHopping {
 public:
  /// Hops on maps of a closed mesh; `shape` weights the shape of faces in the energy. The arguments
  /// must live longer. Where `checkpoint` throws TimeIsOver, hops stay as low as they have come.
  BasinHopping(const Faces& faces, const Eigen::VectorXd& shares, std::int32_t vertices,
               double shape, int threads, core::Checkpoint checkpoint = core::passAll);

  /// Makes a round of hops of several patches from a map that covers the sphere once.
  /// @return the share by which the energy has fallen.
  double hop(Points& map);

 private:
  struct Hop {
    Patch patch;
    std::uint32_t seed;  // of what is scattered
  };

  std::vector<Hop> drawHops(const Points& map);
  Points landing(const Hop& hop, const Points& points) const;
  Eigen::VectorXd energies(const Points& map) const;

  const Faces& faces_;
  const Eigen::VectorXd& shares_;
  double shape_;
  int threads_;
  core::Checkpoint checkpoint_;
  PatchCutter cutter_;
  std::mt19937 random_;
};

}  // namespace spherical_springs::mesh
