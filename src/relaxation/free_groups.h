// Groups of free particles that move by themselves, and what their springs leave open.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "spherical_springs/system.h"

namespace spherical_springs::core {

/// Free particles that springs join, directly or by other free ones, in groups. The energy of the
/// springs is the sum over the groups, as a pinned particle hands nothing on.
class FreeGroups {
 public:
  /// `system` must live longer.
  explicit FreeGroups(const System& system);

  std::size_t count() const { return groups_.size(); }
  /// The free particles of a group, rising.
  const std::vector<std::uint32_t>& particles(std::size_t group) const {
    return groups_[group].particles;
  }

  /// The energy of each group's springs, those to pinned particles among them [J].
  Eigen::VectorXd energies(const Points& positions) const;
  /// The stiffness of each group's springs in sum [J/rad^2, J/sr^2].
  const Eigen::VectorXd& stiffness() const { return stiffness_; }

  /// Returns axes, columns normal to each other, about which a group turns without a change of its
  /// energy: three where no particle of it is joined to a pinned one, one where all those lie on an
  /// axis, else none.
  Eigen::Matrix3Xd axes(std::size_t group, const Points& positions) const;

  /// Returns by how many of its `axes` a group comes to other places: one less than there are where
  /// all its particles lie on one of them, to within 1e-6 rad.
  std::uint32_t rotations(std::size_t group, const Points& positions) const;

  /// Whether the particles of a group and the pinned ones that it is joined to lie on a great
  /// circle, to within 1e-6 rad: it is its own mirror image then.
  bool isFlat(std::size_t group, const Points& positions) const;

  /// Energies of each group's springs that may tell it from its mirror image [J].
  struct MirrorEnergies {
    Eigen::VectorXd here, mirrored;
  };

  /// Returns the energies of the springs of three particles or more, and of those to pinned ones.
  /// Two free particles and their mirror image differ by a rotation alone.
  MirrorEnergies mirrorEnergies(const Points& positions) const;

  /// The positions with each group mirrored at a plane through the centre: the one that is nearest
  /// to its pinned particles.
  Points mirrored(Points positions) const;

 private:
  struct Group {
    std::vector<std::uint32_t> particles, pins;
  };

  template <class Spring>
  std::uint32_t groupOf(const Spring& spring) const;

  const System& system_;
  std::vector<Group> groups_;
  std::vector<std::uint32_t> group_of_;  // of each particle, or kNone
  Eigen::VectorXd stiffness_;
};

}  // namespace spherical_springs::core
