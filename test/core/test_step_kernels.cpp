// The kernels of every instruction set that this processor has against the springs' own formulas.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include "scenes.h"
#include "step_levels.h"

namespace spherical_springs::core {
namespace {

using testing::Random;
using testing::stepKernelsHere;

/// Elements, each on particles of its own, so that the forces on them are those of one element.
struct Bench {
  static constexpr std::uint32_t kCount = 40;

  int ends, arcs;  // corners of an element, and arcs that ride on a triangle
  std::vector<Row> positions, forces;
  std::vector<std::uint32_t> rows[3];
  std::vector<double> rest[3], stiffness[3];
  std::vector<std::uint32_t> hard;

  Bench(int ends, int arcs) : ends(ends), arcs(arcs) {
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
    const double values[3] = {ends == 3 ? area : first, first, second};
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
      for (int i = 0; i <= arcs; ++i) {
        group.springs[i].rest[e % kGroup] = rest[i][e];
        group.springs[i].stiffness[e % kGroup] = stiffness[i][e];
      }
    }
    forces.assign(positions.size(), Row{});
    hard.resize(kCount);
    hard.resize(std::get<ForceKernel<Group>>(kernels.forces)(
        groups.data(), kCount / kGroup, positions[0].values, forces[0].values, hard.data()));
  }

  void run(const StepKernels& kernels) {
    if (ends == 2) return runAs<Arcs>(kernels);
    if (arcs == 0) return runAs<Triangles<0>>(kernels);
    if (arcs == 1) return runAs<Triangles<1>>(kernels);
    return runAs<Triangles<2>>(kernels);
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

  /// Against `condition`; nothing of the hard ones.
  void check(double tolerance) const {
    for (std::uint32_t e = 0; e < kCount; ++e) {
      std::array<Vector3, 3> expected;
      expected.fill(Vector3::Zero());
      std::array<double, 3> scale = {0, 0, 0};
      if (std::count(hard.begin(), hard.end(), e) == 0) {
        if (ends == 3) {
          SolidAngleSpring spring;
          spring.rest_solid_angle = rest[0][e];
          spring.stiffness = stiffness[0][e];
          addExpected(spring, e, 0, expected, scale);
          for (int i = 1; i <= arcs; ++i) addExpected(angleSpring(i, e), e, i - 1, expected, scale);
        } else {
          addExpected(angleSpring(0, e), e, 0, expected, scale);
        }
      }
      for (int i = 0; i < ends; ++i) {
        const Vector3 force = Eigen::Map<const Vector3>(forces[rows[i][e] / kRowLength].values);
        const Vector3 torque = point(e, i).cross(force);
        EXPECT_LE((torque - expected[i]).norm(), tolerance * scale[i])
            << "element " << e << ", end " << i;
      }
    }
  }
};

/// Corners, and arcs on triangles.
class StepKernelsOf : public ::testing::TestWithParam<std::pair<int, int>> {
 protected:
  Bench bench_{GetParam().first, GetParam().second};
};
INSTANTIATE_TEST_SUITE_P(Elements, StepKernelsOf,
                         ::testing::Values(std::pair(2, 0), std::pair(3, 0), std::pair(3, 1),
                                           std::pair(3, 2)));

TEST_P(StepKernelsOf, AreTheConditionsAtAnySize) {
  for (const double size : {1., 0.7, 0.5, 0.3, 0.2, 0.1, 0.03, 0.01, 1e-3, 1e-4, 1e-6}) {
    SCOPED_TRACE(size);
    for (unsigned seed = 1; seed <= 20; ++seed) {
      bench_.fill(size, seed);
      for (const StepKernels* kernels : stepKernelsHere()) {
        bench_.run(*kernels);
        bench_.check(2e-14);
        if (size < 0.3) EXPECT_TRUE(bench_.hard.empty());
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
  if (GetParam().first == 2) return;
  for (const double size : {1., 0.05}) {
    bench_.fill(size, 6);
    for (std::uint32_t e = 0; e < Bench::kCount; ++e) bench_.rest[0][e] = e % 2 == 0 ? -6 : 6.2;
    for (const StepKernels* kernels : stepKernelsHere()) {
      bench_.run(*kernels);
      bench_.check(2e-14);
    }
  }
}

TEST(StepKernels, AreTheWidestThatTheProcessorHas) {
  EXPECT_EQ(&stepKernels(), stepKernelsHere().back());
}

}  // namespace
}  // namespace spherical_springs::core
