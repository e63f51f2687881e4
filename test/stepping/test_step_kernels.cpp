// The kernels of every instruction set that this processor has against the springs' own formulas.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include "support/scenes.h"
#include "support/step_levels.h"

namespace spherical_springs::core {
namespace {

using testing::Random;
using testing::stepKernelsHere;

enum class Sort { arcs, triangles, triangles_with_arc, triangles_with_arcs, oriented_arcs };

/// Elements, each on particles of its own, so that the forces on them are those of one element.
struct Bench {
  static constexpr std::uint32_t kCount = 40;

  Sort sort;
  int ends, springs;  // of an element
  std::vector<Row> positions, forces;
  std::vector<std::uint32_t> rows[3];
  std::vector<double> rest[3], stiffness[3];
  std::vector<double> width;
  std::vector<std::uint32_t> hard, near;

  explicit Bench(Sort sort)
      : sort(sort),
        ends(sort == Sort::arcs ? 2 : 3),
        springs(sort == Sort::triangles_with_arcs  ? 3
                : sort == Sort::triangles_with_arc ? 2
                                                   : 1),
        width(kCount) {
    for (int i = 0; i < 3; ++i) {
      rows[i].resize(kCount);
      rest[i].resize(kCount);
      stiffness[i].resize(kCount);
    }
    positions.resize(3 * kCount);
    // Rows that lie next to each other belong to different elements.
    for (std::uint32_t e = 0; e < kCount; ++e) {
      for (std::uint32_t i = 0; i < 3; ++i)
        rows[i][e] = kRowLength * ((7 * e + 13) % kCount + i * kCount);
    }
  }

  Vector3 point(std::uint32_t e, int end) const {
    return Eigen::Map<const Vector3>(positions[rows[end][e] / kRowLength].values);
  }
  void put(std::uint32_t e, const std::array<Vector3, 3>& points, Random& random) {
    for (int i = 0; i < 3; ++i) {
      Eigen::Map<Vector3>(positions[rows[i][e] / kRowLength].values) = points[i];
    }
    const auto off = [&] { return random.between(0.5, 1.5); };
    const double area = solidAngle(points[0], points[1], points[2]) * off();
    const double first = arc(points[0], points[1]).angle * off();
    const double second = arc(points[1], points[2]).angle * off();
    const bool is_triangle = sort != Sort::arcs && sort != Sort::oriented_arcs;
    const double values[3] = {is_triangle ? area : first, first, second};
    // Not so narrow that the rounding of the triple product decides.
    width[e] =
        random.between(0.3, 1) * (points[0] - points[1]).norm() * (points[1] - points[2]).norm();
    for (int i = 0; i < 3; ++i) {
      rest[i][e] = std::min(values[i], kPi);
      stiffness[i][e] = random.between(0.5, 2);
    }
  }

  /// Triangles, or arcs between their first two corners, of up to `size`.
  void fill(double size, unsigned seed) {
    Random random(seed);
    for (std::uint32_t e = 0; e < kCount; ++e) {
      const Vector3 first = random.unitVector();
      auto points = random.unitVectors<3>();
      for (Vector3& p : points) p = (first + size * (p - first)).normalized();
      put(e, points, random);
    }
  }

  template <class Group>
  void runAs(const StepKernels& kernels) {
    std::vector<Group> groups(kCount / kGroup);
    for (std::uint32_t e = 0; e < kCount; ++e) {
      Group& group = groups[e / kGroup];
      for (int i = 0; i < ends; ++i) group.ends[i][e % kGroup] = rows[i][e];
      for (int i = 0; i < springs; ++i) {
        group.springs[i].rest[e % kGroup] = rest[i][e];
        group.springs[i].stiffness[e % kGroup] = stiffness[i][e];
      }
    }
    runGroups(groups, kernels);
  }

  void runOriented(const StepKernels& kernels) {
    std::vector<OrientedArcs> groups(kCount / kGroup);
    for (std::uint32_t e = 0; e < kCount; ++e) {
      OrientedArcs& group = groups[e / kGroup];
      for (int i = 0; i < 3; ++i) group.ends[i][e % kGroup] = rows[i][e];
      group.springs[0].rest[e % kGroup] = rest[0][e];
      group.springs[0].stiffness[e % kGroup] = stiffness[0][e];
      group.width[e % kGroup] = width[e];
    }
    runGroups(groups, kernels);
  }

  template <class Group>
  void runGroups(const std::vector<Group>& groups, const StepKernels& kernels) {
    forces.assign(positions.size(), Row{});
    hard.resize(kCount);
    near.resize(kCount);
    MarkedElements marked = {hard.data(), near.data()};
    std::get<ForceKernel<Group>>(kernels.forces)(groups.data(), kCount / kGroup,
                                                 positions[0].values, forces[0].values, marked);
    hard.resize(marked.hard_count);
    near.resize(marked.near_count);
  }

  void run(const StepKernels& kernels) {
    switch (sort) {
      case Sort::arcs:
        return runAs<Arcs>(kernels);
      case Sort::triangles:
        return runAs<Triangles<0>>(kernels);
      case Sort::triangles_with_arc:
        return runAs<Triangles<1>>(kernels);
      case Sort::triangles_with_arcs:
        return runAs<Triangles<2>>(kernels);
      case Sort::oriented_arcs:
        return runOriented(kernels);
    }
  }

  double squaredEdge(std::uint32_t e, int i, int j) const {
    return (point(e, i) - point(e, j)).squaredNorm();
  }

  template <class Spring>
  void addExpected(const Spring& spring, std::uint32_t e, int first_end,
                   std::array<Vector3, 3>& torques, std::array<double, 3>& scale) const {
    std::array<Vector3, Spring::kParticles> points;
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = point(e, first_end + int(i));
    const auto c = condition(spring, points);
    // A triangle's area is as good as the square of its longest edge.
    double value = std::abs(c.value) + std::abs(spring.restValue());
    if (points.size() == 3) {
      value += std::max({squaredEdge(e, 0, 1), squaredEdge(e, 1, 2), squaredEdge(e, 2, 0)});
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      torques[first_end + i] -= spring.stiffness * c.value * c.gradient[i];
      scale[first_end + i] += spring.stiffness * value * c.gradient[i].norm();
    }
  }

  AngleSpring angleSpring(int constants, std::uint32_t e) const {
    AngleSpring spring;
    spring.rest_angle = rest[constants][e];
    spring.stiffness = stiffness[constants][e];
    return spring;
  }

  void addElement(std::uint32_t e, std::array<Vector3, 3>& torques,
                  std::array<double, 3>& scale) const {
    if (sort == Sort::oriented_arcs) {
      OrientedAngleSpring spring;
      spring.rest_angle = rest[0][e];
      spring.stiffness = stiffness[0][e];
      spring.width = width[e];
      return addExpected(spring, e, 0, torques, scale);
    }
    if (sort == Sort::arcs) return addExpected(angleSpring(0, e), e, 0, torques, scale);
    SolidAngleSpring spring;
    spring.rest_solid_angle = rest[0][e];
    spring.stiffness = stiffness[0][e];
    addExpected(spring, e, 0, torques, scale);
    for (int i = 1; i < springs; ++i) addExpected(angleSpring(i, e), e, i - 1, torques, scale);
  }

  /// Against `condition`; nothing of the hard ones.
  void check(double tolerance) const {
    for (std::uint32_t e = 0; e < kCount; ++e) {
      std::array<Vector3, 3> expected;
      expected.fill(Vector3::Zero());
      std::array<double, 3> scale = {0, 0, 0};
      if (std::count(hard.begin(), hard.end(), e) == 0) addElement(e, expected, scale);
      // Rounding at one end shows at the others, whose torques may cancel.
      const double largest = *std::max_element(scale.begin(), scale.end());
      for (int i = 0; i < ends; ++i) {
        const Vector3 force = Eigen::Map<const Vector3>(forces[rows[i][e] / kRowLength].values);
        const Vector3 torque = point(e, i).cross(force);
        EXPECT_LE((torque - expected[i]).norm(), tolerance * largest)
            << "element " << e << ", end " << i;
      }
    }
  }
};

class StepKernelsOf : public ::testing::TestWithParam<Sort> {
 protected:
  Bench bench_{GetParam()};
};
INSTANTIATE_TEST_SUITE_P(Elements, StepKernelsOf,
                         ::testing::Values(Sort::arcs, Sort::triangles, Sort::triangles_with_arc,
                                           Sort::triangles_with_arcs, Sort::oriented_arcs));

TEST_P(StepKernelsOf, AreTheConditionsAtAnySize) {
  for (const double size : {1., 0.7, 0.5, 0.3, 0.2, 0.1, 0.03, 0.01, 1e-3, 1e-4, 1e-6}) {
    SCOPED_TRACE(size);
    if (GetParam() == Sort::oriented_arcs && size < 1e-5) continue;  // the sign changes sharply
    for (unsigned seed = 1; seed <= 20; ++seed) {
      bench_.fill(size, seed);
      for (const StepKernels* kernels : stepKernelsHere()) {
        bench_.run(*kernels);
        bench_.check(2e-14);
        if (size < 0.3 && size > 1e-5) {
          EXPECT_TRUE(bench_.hard.empty());
        }
      }
    }
  }
}

// With the sizes of the sides of a triangle far apart, down to all but flat.
TEST_P(StepKernelsOf, AreTheConditionsOfSlivers) {
  for (const double flatness : {0.3, 0.1, 1e-3, 1e-6, 1e-9, 0.}) {
    SCOPED_TRACE(flatness);
    Random random(5);
    for (std::uint32_t e = 0; e < Bench::kCount; ++e) {
      const Vector3 a = random.unitVector();
      const Vector3 along = a.cross(random.unitVector()).normalized();
      const double size = random.between(0.01, 0.2);
      const Vector3 b = rotated(a, size * along);
      const Vector3 middle = rotated(a, random.between(0.1, 0.9) * size * along);
      const Vector3 c = (middle + flatness * size * along).normalized();
      bench_.put(e, {a, b, c}, random);
      bench_.rest[0][e] = 0.3;  // far from what it is, so that forces are large
    }
    for (const StepKernels* kernels : stepKernelsHere()) {
      bench_.run(*kernels);
      bench_.check(2e-13);
      EXPECT_TRUE(bench_.hard.empty());
    }
  }
}

// One that is hard does not spoil those beside it.
TEST_P(StepKernelsOf, LeaveTheHardOut) {
  for (const double distance : {0., 1e-12, 1e-9}) {
    bench_.fill(0.2, 3);
    Random random(4);
    const Vector3 a = Vector3(1, 2, 3).normalized();
    const Vector3 beside = rotated(a, distance * perpendicular(a));
    bench_.put(17, {a, -beside, Vector3(1, 0, 0)}, random);
    for (const StepKernels* kernels : stepKernelsHere()) {
      bench_.run(*kernels);
      bench_.check(2e-14);
      EXPECT_EQ(bench_.hard, std::vector<std::uint32_t>{17});
    }
  }
}

// The area of an oriented triangle is modulo 4 pi.
TEST_P(StepKernelsOf, WrapTheArea) {
  if (GetParam() == Sort::arcs || GetParam() == Sort::oriented_arcs) return;
  for (const double size : {1., 0.05}) {
    bench_.fill(size, 6);
    for (std::uint32_t e = 0; e < Bench::kCount; ++e)
      bench_.rest[0][e] = e % 2 == 0 ? -6.2831 : 6.2831;
    for (const StepKernels* kernels : stepKernelsHere()) {
      bench_.run(*kernels);
      bench_.check(2e-14);
    }
  }
}

TEST(StepKernels, LeaveSharpChangesOfSignOut) {
  Bench bench(Sort::oriented_arcs);
  bench.fill(0.2, 7);
  bench.width[9] = 0;
  for (const StepKernels* kernels : stepKernelsHere()) {
    bench.run(*kernels);
    bench.check(2e-14);
    EXPECT_EQ(bench.hard, std::vector<std::uint32_t>{9});
  }
}

TEST(StepKernels, AreTheWidestThatTheProcessorHas) {
  EXPECT_EQ(&stepKernels(), stepKernelsHere().back());
}

}  // namespace
}  // namespace spherical_springs::core
