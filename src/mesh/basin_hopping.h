// Ways out of the minima in which a map ends.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "patch.h"

namespace spherical_springs::mesh {

/// Basin hopping (Wales and Doye, J. Phys. Chem. A 101, 1997) on patches of a map about faces whose
/// areas are wrong: vertices go after shares with noise, then after the true ones, and stay where
/// the energy is lower. What is left of an energy is mostly the matter of a few hundred vertices.
class BasinHopping {
 public:
  /// Of a closed mesh, with the weight of the shape of its faces in their energy; what is passed
  /// must live longer.
  BasinHopping(const Faces& faces, const Eigen::VectorXd& shares, std::int32_t vertices,
               double shape, int threads);

  /// Makes a round of hops, of small patches and of larger ones, from a map that covers the sphere
  /// once.
  /// @return the share by which the energy has fallen.
  double hop(Points& map);

 private:
  struct Try {
    std::size_t patch;
    std::uint32_t seed;  // of the noise
    Points points;       // of the patch after it
  };

  void hop(std::size_t size, Points& map);
  Eigen::VectorXd energies(const Faces& faces, const Eigen::VectorXd& shares,
                           const Points& points) const;
  Points hopped(const Patch& patch, const Points& points, std::uint32_t seed) const;
  Points descended(const Patch& patch, const Eigen::VectorXd& shares, const Points& points,
                   double slow) const;
  std::vector<Patch> drawPatches(std::size_t size, const Points& map, std::vector<Try>& tries);

  const Faces& faces_;
  const Eigen::VectorXd& shares_;
  double shape_;
  int threads_;
  PatchCutter cutter_;
  std::mt19937 random_;
};

}  // namespace spherical_springs::mesh
