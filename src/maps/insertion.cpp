#include "maps/insertion.h"

#include <algorithm>
#include <cmath>

#include "maps/coverage.h"

namespace spherical_springs::mesh {
namespace {

using Ring = std::vector<std::int32_t>;

double angleAt(const Vector3& p, const Vector3& from, const Vector3& to) {
  return std::atan2(core::tripleProduct(p, from, to), p.cross(from).dot(p.cross(to)));
}

/// Area of the smallest face that `p` makes with its ring; negative where one may be folded.
double leastFace(const Vector3& p, const Ring& ring, const Points& points) {
  double least = 4 * core::kPi;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vector3 a = points.col(ring[i]), b = points.col(ring[(i + 1) % ring.size()]);
    if (!surelyPositive(p, a, b)) return -1;
    least = std::min(least, core::solidAngle(p, a, b));
  }
  return least;
}

/// Whether no face has an area above `least` two of whose sides have these chords. Such a face has
/// at most 2 asin(tan(side / 2) tan(other side / 2)), which is .68 of their product up to 1.
bool isSmaller(double chord, double other_chord, double least) {
  return chord < 1 && other_chord < 1 && chord * other_chord < least;
}

}  // namespace

/// Close enough to the first of the ring, on the bisector of the ring's angle there, all faces are
/// positive.
Vector3 placeInside(const Ring& ring, const Points& points) {
  const Vector3 corner = points.col(ring[0]);
  double angle = 0;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
    angle += angleAt(corner, points.col(ring[i]), points.col(ring[i + 1]));
  }
  const Vector3 second = points.col(ring[1]);
  const Vector3 along = (second - second.dot(corner) * corner).normalized();
  const Vector3 inward =
      std::cos(0.5 * angle) * along + std::sin(0.5 * angle) * corner.cross(along);
  Vector3 centre = Vector3::Zero();
  double length = 0;
  for (const std::int32_t w : ring) {
    centre += points.col(w);
    length = std::max(length, (points.col(w) - corner).norm());
  }
  Vector3 best = centre.normalized();
  double least = leastFace(best, ring, points);
  const double side = (second - corner).norm();
  for (int halving = 0; halving < 50; ++halving, length *= 0.6) {
    if (isSmaller(length, side, least)) break;
    const Vector3 place = (corner + length * inward).normalized();
    const double smallest = leastFace(place, ring, points);
    if (smallest > least) {
      least = smallest;
      best = place;
    }
  }
  return best;
}

}  // namespace spherical_springs::mesh
