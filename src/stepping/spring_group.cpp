#include "stepping/spring_group.h"

namespace spherical_springs::core {

void SpringGroup::clear() {
  positions.clear();
  angular_velocities.clear();
  inverse_masses.clear();
  frequencies.clear();
  springs.clear();
  ids.clear();
}

void SpringGroup::drift(std::uint32_t particle, double duration) {
  Vector3& position = positions[particle];
  Vector3& velocity = angular_velocities[particle];
  position = rotated(position, duration * velocity);
  velocity -= position.dot(velocity) * position;  // rounding alone has put it there
}

}  // namespace spherical_springs::core
