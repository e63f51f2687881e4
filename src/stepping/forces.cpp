#include "stepping/forces.h"

#include <tuple>

#include "stepping/exact_springs.h"

namespace spherical_springs::core {

namespace {

template <class Spring>
void addExactly(const Spring& spring, const std::array<std::uint32_t, Spring::kParticles>& rows,
                const Row* positions, std::vector<Row>& forces) {
  const auto points = pointsAt(rows, positions);
  const auto c = condition(spring, points);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Vector3 torque = -spring.stiffness * c.value * c.gradient[i];
    Eigen::Map<Vector3>(forces[rows[i]].values) += torque.cross(points[i]);
  }
}

}  // namespace

const Row* Forces::on(const Patch& patch, const Row* positions, Scratch& scratch) const {
  forEachSort([&](auto sort) { addElements(sort, patch, positions, scratch); });
  return scratch.sums.data();
}

template <class Group>
void Forces::addElements(Kind<Group> sort, const Patch& patch, const Row* positions,
                         Scratch& scratch) const {
  const auto [begin, end] = patch.groups[sortOf<Group>()];
  if (begin == end) return;
  const Group* const groups = std::get<GroupList<Group>>(layout_.groups()).data() + begin;
  const std::uint32_t hard_count = forceKernel(kernels_, sort)(
      groups, end - begin, positions->values, scratch.sums[0].values, scratch.hard.data());
  for (std::uint32_t h = 0; h < hard_count; ++h) {
    const std::uint32_t element = scratch.hard[h];
    forEachSpring(groups[element / kGroup], element % kGroup,
                  [&](const auto& spring, const auto& rows) {
                    addExactly(spring, rows, positions, scratch.sums);
                  });
  }
}

}  // namespace spherical_springs::core
