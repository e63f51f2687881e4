#include "surfaces/projection.h"

#include <cmath>
#include <stdexcept>

#include "spherical_springs/range.h"

namespace spherical_springs::mesh {
namespace {

struct Name {
  const char* name;
  Projection projection;
};

constexpr Name kNames[] = {{"longitude-latitude", Projection::longitude_latitude},
                           {"equal-area-cylinder", Projection::equal_area_cylinder},
                           {"equal-area-octahedron", Projection::equal_area_octahedron}};

double longitudeOf(const Vector3& p, const Side& side) {
  return std::atan2(p.y() == 0 ? std::copysign(0., side[1]) : p.y(), p.x());
}

/// One octant, in which the lengths of u and v add up to sqrt(1 - |z|), is turned inside out on the
/// southern half.
Eigen::Vector2d octahedronPlace(const Vector3& p, const Side& side) {
  const double height = std::abs(p.z());
  // 1 - |z| without loss of digits near the pole.
  const double radius = std::hypot(p.x(), p.y()) / std::sqrt(1 + height);
  const double turn = std::atan2(std::abs(p.y()), std::abs(p.x())) * 2 / core::kPi;
  Eigen::Vector2d place(radius * (1 - turn), radius * turn);
  if (side[2] < 0) place = Eigen::Vector2d(1 - place.y(), 1 - place.x());
  return {0.5 + side[0] * place.x() / 2, 0.5 + side[1] * place.y() / 2};
}

}  // namespace

Projection projection(const std::string& name) {
  for (const Name& entry : kNames) {
    if (name == entry.name) return entry.projection;
  }
  throw std::invalid_argument(core::quoted(name) +
                              "; allowed: longitude-latitude, equal-area-cylinder or "
                              "equal-area-octahedron");
}

Eigen::Vector2d placeOf(Projection projection, const Vector3& direction, const Side& side) {
  const Vector3& p = direction;
  const double u = 0.5 + longitudeOf(p, side) / (2 * core::kPi);
  switch (projection) {
    case Projection::longitude_latitude:
      return {u, 0.5 + std::atan2(p.z(), std::hypot(p.x(), p.y())) / core::kPi};
    case Projection::equal_area_cylinder:
      return {u, (1 + p.z()) / 2};
    case Projection::equal_area_octahedron:
      break;
  }
  return octahedronPlace(p, side);
}

}  // namespace spherical_springs::mesh
