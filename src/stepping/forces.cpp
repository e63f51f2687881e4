#include "stepping/forces.h"

#include <tuple>

#include "stepping/approach.h"
#include "stepping/exact_springs.h"

namespace spherical_springs::core {

namespace {

template <class Spring>
void addExactly(const Spring& spring, const std::array<std::uint32_t, Spring::kParticles>& rows,
                const Row* positions, std::vector<Row>& forces) {
  const auto of_spring = forcesOf(spring, pointsAt(rows, positions));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    Eigen::Map<Vector3>(forces[rows[i]].values) += of_spring[i];
  }
}

}  // namespace

const Row* Forces::on(const Patch& patch, const Row* positions, Scratch& scratch,
                      NearElements* near) const {
  forEachSort([&](auto sort) { addElements(sort, patch, positions, scratch, near); });
  return scratch.sums.data();
}

template <class Group>
void Forces::addElements(Kind<Group> sort, const Patch& patch, const Row* positions,
                         Scratch& scratch, NearElements* near) const {
  const auto [begin, end] = patch.groups[sortOf<Group>()];
  if (begin == end) return;
  const Group* const groups = std::get<GroupList<Group>>(layout_.groups()).data() + begin;
  MarkedElements marked = {scratch.hard.data(), scratch.near.data()};
  forceKernel(kernels_, sort)(groups, end - begin, positions->values, scratch.sums[0].values,
                              marked);
  for (std::uint32_t h = 0; h < marked.hard_count; ++h) {
    const std::uint32_t element = marked.hard[h];
    bool is_near = false;
    forEachSpring(groups[element / kGroup], element % kGroup,
                  [&](const auto& spring, const auto& rows) {
                    is_near |= near != nullptr && isNear(spring, pointsAt(rows, positions));
                    addExactly(spring, rows, positions, scratch.sums);
                  });
    if (is_near) marked.near[marked.near_count++] = element;
  }
  if (near != nullptr) {
    (*near)[sortOf<Group>()].assign(marked.near, marked.near + marked.near_count);
  }
}

}  // namespace spherical_springs::core
