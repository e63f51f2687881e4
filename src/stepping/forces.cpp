#include "forces.h"

#include <algorithm>
#include <tuple>

#include "exact_springs.h"

namespace spherical_springs::core {

Scratch& Scratch::cleared(const Layout& layout, const Patch& patch) {
  static thread_local Scratch scratch;
  if (scratch.sums.size() < layout.largestPatch()) scratch.sums.resize(layout.largestPatch());
  std::fill_n(scratch.sums.begin(), patch.row_count, Row{});
  return scratch;
}

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

template <int kEnds, int kSprings>
void addExactly(const ElementGroup<kEnds, kSprings>& group, std::uint32_t lane,
                const Row* positions, std::vector<Row>& forces) {
  if constexpr (kEnds == 3) {
    SolidAngleSpring triangle;
    triangle.rest_solid_angle = group.springs[0].rest[lane];
    triangle.stiffness = group.springs[0].stiffness[lane];
    addExactly(triangle, rowsOf<3>(group, lane), positions, forces);
  }
  constexpr int kFirstArc = kEnds - 2;
  for (int i = kFirstArc; i < kSprings; ++i) {
    AngleSpring arc;
    arc.rest_angle = group.springs[i].rest[lane];
    arc.stiffness = group.springs[i].stiffness[lane];
    addExactly(arc, rowsOf<2>(group, lane, i - kFirstArc), positions, forces);
  }
}

void addExactly(const OrientedArcs& group, std::uint32_t lane, const Row* positions,
                std::vector<Row>& forces) {
  OrientedAngleSpring spring;
  spring.rest_angle = group.rest[lane];
  spring.stiffness = group.stiffness[lane];
  spring.width = widthOfSpring(group.width[lane]);
  addExactly(spring, rowsOf<3>(group, lane), positions, forces);
}

}  // namespace

const Row* Forces::on(const Patch& patch, const Row* positions) const {
  Scratch& scratch = Scratch::cleared(layout_, patch);
  addElements<0>(patch, positions, scratch);
  addElements<1>(patch, positions, scratch);
  addElements<2>(patch, positions, scratch);
  addElements<3>(patch, positions, scratch);
  addElements<4>(patch, positions, scratch);
  return scratch.sums.data();
}

template <int kSort>
void Forces::addElements(const Patch& patch, const Row* positions, Scratch& scratch) const {
  const auto [begin, end] = patch.groups[kSort];
  if (begin == end) return;
  const auto* const groups = std::get<kSort>(layout_.groups()).data() + begin;
  scratch.makeRoom(kGroup * (end - begin));
  const std::uint32_t hard_count = std::get<kSort>(kernels_.forces)(
      groups, end - begin, positions->values, scratch.sums[0].values, scratch.hard.data());
  for (std::uint32_t h = 0; h < hard_count; ++h) {
    const std::uint32_t element = scratch.hard[h];
    addExactly(groups[element / kGroup], element % kGroup, positions, scratch.sums);
  }
}

}  // namespace spherical_springs::core
