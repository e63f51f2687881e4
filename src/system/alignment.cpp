#include "system/alignment.h"

#include <Eigen/SVD>
#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "system/groups.h"

namespace spherical_springs::core {
namespace {

struct Group {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // sum of after before^T
  std::size_t size = 0;
  bool moved = false, calm = true;
  Vector3 pin = Vector3::Zero();
  bool fixed = false;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();

  void addPin(const Vector3& place) {
    if (pin.isZero(0)) pin = place;
    fixed = fixed || !crossOfUnits(pin, place).isZero(0);
  }

  bool stays() const { return size == 1 || !moved; }

  void findTurn() {
    if (fixed || stays()) return;
    if (!pin.isZero(0)) {
      turnAboutPin();
      return;
    }
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance,
                                                Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Matrix3d v = svd.matrixV();
    if ((v * svd.matrixU().transpose()).determinant() < 0) v.col(2) *= -1;
    turn = v * svd.matrixU().transpose();
  }

  Vector3 turned(const Vector3& point) const {
    if (fixed) return point;
    const Vector3 p = turn * point;
    return p * (1.5 - 0.5 * p.squaredNorm());
  }

 private:
  /// The angle that brings the traces of after and before across the pin together.
  void turnAboutPin() {
    const double along = pin.dot(covariance * pin);
    const Vector3 twist(covariance(1, 2) - covariance(2, 1), covariance(2, 0) - covariance(0, 2),
                        covariance(0, 1) - covariance(1, 0));
    const double angle = std::atan2(pin.dot(twist), covariance.trace() - along);
    turn = Eigen::AngleAxisd(angle, pin).toRotationMatrix();
  }
};

/// Groups by number, with all that finding their turns needs.
std::vector<Group> groupsAt(const System& system, const std::vector<std::uint32_t>& group_of,
                            const Points& before, const Points& after,
                            const std::vector<bool>& calm) {
  std::vector<Group> groups;
  for (std::size_t i = 0; i < group_of.size(); ++i) {
    if (group_of[i] >= groups.size()) groups.resize(group_of[i] + 1);
    Group& group = groups[group_of[i]];
    group.covariance += after.col(i) * before.col(i).transpose();
    ++group.size;
    group.moved = group.moved || after.col(i) != before.col(i);
    group.calm = group.calm && !calm.empty() && calm[i];
    if (system.pinned(i)) group.addPin(after.col(i));
  }
  return groups;
}

}  // namespace

Points aligned(const System& system, const Points& before, Points after,
               const std::vector<bool>& calm) {
  constexpr double kStill = 1e-6;  // [rad]
  const auto group_of = groupsOf(system, Pins::join);
  std::vector<Group> groups = groupsAt(system, group_of, before, after, calm);
  for (Group& group : groups) group.findTurn();
  parallelFor(after.cols(), system.threads(), [&](std::ptrdiff_t i) {
    const Group& group = groups[group_of[i]];
    if (!group.stays() && !system.pinned(i)) after.col(i) = group.turned(after.col(i));
  });
  for (std::size_t i = 0; i < group_of.size(); ++i) {
    Group& group = groups[group_of[i]];
    group.calm = group.calm && (after.col(i) - before.col(i)).squaredNorm() < kStill * kStill;
  }
  for (std::size_t i = 0; i < group_of.size(); ++i) {
    const Group& group = groups[group_of[i]];
    if (group.stays() || group.calm) after.col(i) = before.col(i);
  }
  return after;
}

}  // namespace spherical_springs::core
