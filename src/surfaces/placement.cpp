#include "surfaces/placement.h"

#include <Eigen/Geometry>
#include <stdexcept>

namespace spherical_springs::mesh {
namespace {

Eigen::Index farthest(const TriangleMesh& surface, const Vector3& direction) {
  Eigen::Index vertex;
  (direction.normalized().transpose() * surface.vertices).maxCoeff(&vertex);
  return vertex;
}

Eigen::Matrix3d shortestTurn(const Vector3& from, const Vector3& to) {
  return Eigen::Quaterniond::FromTwoVectors(from, to).toRotationMatrix();
}

/// The turn after which `pole` lies at z and `front` in the half plane of x.
Eigen::Matrix3d turnOfBoth(const Vector3& pole, const Vector3& front) {
  constexpr double kOpposite = 1e-9;
  const Vector3 y = pole.cross(front);
  if (y.norm() < kOpposite) return shortestTurn(pole, Vector3::UnitZ());
  Eigen::Matrix3d turn;
  turn.row(1) = y.normalized();
  turn.row(2) = pole.normalized();
  turn.row(0) = turn.row(1).cross(turn.row(2));
  return turn;
}

}  // namespace

void requireTwoVertices(const TriangleMesh& surface, const Placement& placement) {
  if (!placement.pole || !placement.front) return;
  if (farthest(surface, *placement.pole) != farthest(surface, *placement.front)) return;
  throw std::invalid_argument(
      "--pole and --front choose the same vertex; allowed: directions in which different vertices "
      "are the farthest");
}

Points placed(const TriangleMesh& surface, const Points& sphere, const Placement& placement) {
  if (!placement.pole && !placement.front) return sphere;
  Eigen::Matrix3d turn;
  Eigen::Index at_pole = -1, in_front = -1;
  if (placement.pole) at_pole = farthest(surface, *placement.pole);
  if (placement.front) in_front = farthest(surface, *placement.front);
  if (placement.pole && placement.front) {
    turn = turnOfBoth(sphere.col(at_pole), sphere.col(in_front));
  } else if (placement.pole) {
    turn = shortestTurn(sphere.col(at_pole), Vector3::UnitZ());
  } else {
    turn = shortestTurn(sphere.col(in_front), Vector3::UnitX());
  }
  Points result = turn * sphere;
  result.colwise().normalize();
  // To the last bit, as seams and poles go by zeros.
  if (placement.pole) {
    result.col(at_pole) = Vector3::UnitZ();
  } else {
    result.col(in_front) = Vector3::UnitX();
  }
  return result;
}

}  // namespace spherical_springs::mesh
