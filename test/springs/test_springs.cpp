#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "spherical_springs/springs/kinds.h"
#include "support/scenes.h"

namespace spherical_springs::core {
namespace {

using testing::Random;

template <class Spring>
class Springs : public ::testing::Test {};

using Kinds = ::testing::Types<AngleSpring, SolidAngleSpring, OrientedAngleSpring>;
TYPED_TEST_SUITE(Springs, Kinds, );

template <std::size_t N>
TangentFrame frameOf(const std::array<Vector3, N>& points, std::size_t i) {
  TangentFrame frame;
  frame << perpendicular(points[i]), points[i].cross(perpendicular(points[i]));
  return frame;
}

template <std::size_t N>
std::array<TangentFrame, N> framesOf(const std::array<Vector3, N>& points) {
  std::array<TangentFrame, N> frames;
  for (std::size_t i = 0; i < N; ++i) frames[i] = frameOf(points, i);
  return frames;
}

/// `points` after particle i has gone by `step` along its tangent vector `along`.
template <std::size_t N>
std::array<Vector3, N> movedPoints(std::array<Vector3, N> points, std::size_t i,
                                   const Vector3& along, double step) {
  points[i] = rotated(points[i], step * points[i].cross(along));
  return points;
}

constexpr double kStep = 1e-5;

template <class Spring, std::size_t N>
double slope(const Spring& spring, const std::array<Vector3, N>& points, std::size_t i,
             const Vector3& along, double step) {
  return (condition(spring, movedPoints(points, i, along, step)).value -
          condition(spring, movedPoints(points, i, along, -step)).value) /
         (2 * step);
}

TYPED_TEST(Springs, GradientIsTheSlopeOfTheCondition) {
  constexpr std::size_t N = TypeParam::kParticles;
  Random random(1);
  for (int trial = 0; trial < 500; ++trial) {
    const auto spring = random.spring<TypeParam>({});
    const auto points = random.unitVectors<N>();
    const auto c = condition(spring, points);
    for (std::size_t i = 0; i < N; ++i) {
      const TangentFrame frame = frameOf(points, i);
      EXPECT_NEAR(c.gradient[i].dot(points[i]), 0, 1e-12);
      for (int axis = 0; axis < 2; ++axis) {
        const Vector3 along = frame.col(axis);
        // The tangent vector t is the rotation p x t, so the slope is gradient . (p x t).
        const double expected = slope(spring, points, i, along, kStep);
        EXPECT_NEAR(c.gradient[i].dot(points[i].cross(along)), expected,
                    1e-7 * (1 + std::pow(c.gradient[i].norm(), 3)));
      }
    }
  }
}

// Close pairs and triangles down to edges of 1e-4, where the step of the difference is a share of
// the edge.
TYPED_TEST(Springs, GradientOfSmallConfigurations) {
  constexpr std::size_t N = TypeParam::kParticles;
  Random random(2);
  for (const double size : {1e-1, 1e-2, 1e-3, 1e-4}) {
    for (int trial = 0; trial < 50; ++trial) {
      auto spring = random.spring<TypeParam>({});
      auto points = random.unitVectors<N>();
      for (std::size_t i = 1; i < N; ++i) {
        points[i] = (points[0] + size * (points[i] - points[0])).normalized();
      }
      rest(spring, points);  // so that the difference of values keeps its digits
      const auto c = condition(spring, points);
      double scale = 0;
      for (const Vector3& gradient : c.gradient) scale = std::max(scale, gradient.norm());
      for (std::size_t i = 0; i < N; ++i) {
        const Vector3 along = perpendicular(points[i]);
        const double expected = slope(spring, points, i, along, 1e-4 * size);
        EXPECT_NEAR(c.gradient[i].dot(points[i].cross(along)), expected, 2e-5 * scale) << size;
      }
    }
  }
}

TYPED_TEST(Springs, TorquesSumToZero) {
  Random random(3);
  for (int trial = 0; trial < 500; ++trial) {
    const auto spring = random.spring<TypeParam>({});
    const auto c = condition(spring, random.unitVectors<TypeParam::kParticles>());
    Vector3 sum = Vector3::Zero();
    double scale = 1;
    for (const Vector3& gradient : c.gradient) {
      sum += gradient;
      scale = std::max(scale, gradient.squaredNorm());
    }
    EXPECT_LT(sum.norm(), 1e-14 * scale);
  }
}

TYPED_TEST(Springs, TangentConditionAgreesWithTheCondition) {
  constexpr std::size_t N = TypeParam::kParticles;
  Random random(4);
  for (int trial = 0; trial < 200; ++trial) {
    const auto spring = random.spring<TypeParam>({});
    const auto points = random.unitVectors<N>();
    const auto frames = framesOf(points);
    const auto c = condition(spring, points);
    const auto t = tangentCondition(spring, points, frames, Curvature::exact);
    EXPECT_NEAR(t.value, c.value, 1e-14);
    for (std::size_t i = 0; i < N; ++i) {
      const Vector3 tangent = c.gradient[i].cross(points[i]);
      EXPECT_LT((t.gradient[i] - frames[i].transpose() * tangent).norm(),
                1e-13 * (1 + tangent.norm()));
    }
  }
}

TYPED_TEST(Springs, HessianIsTheSlopeOfTheGradient) {
  constexpr std::size_t N = TypeParam::kParticles;
  Random random(5);
  int tried = 0;
  while (tried < 200) {
    const auto spring = random.spring<TypeParam>({});
    const auto points = random.unitVectors<N>();
    bool near_antipodal = false;  // where third derivatives spoil the difference
    for (std::size_t i = 0; i < N; ++i) {
      near_antipodal = near_antipodal || (points[i] + points[(i + 1) % N]).norm() < 0.5 ||
                       (points[i] - points[(i + 1) % N]).norm() < 0.3;
    }
    if (near_antipodal) continue;
    ++tried;
    const auto frames = framesOf(points);
    const auto t = tangentCondition(spring, points, frames, Curvature::exact);
    for (std::size_t j = 0; j < N; ++j) {
      for (int axis = 0; axis < 2; ++axis) {
        const Vector3 along = frames[j].col(axis);
        const auto ahead = condition(spring, movedPoints(points, j, along, kStep));
        const auto behind = condition(spring, movedPoints(points, j, along, -kStep));
        const auto ahead_points = movedPoints(points, j, along, kStep);
        const auto behind_points = movedPoints(points, j, along, -kStep);
        for (std::size_t i = 0; i < N; ++i) {
          // Along a geodesic the frame keeps its angle to the path; its normal part plays no role.
          const Vector3 difference =
              ahead.gradient[i].cross(ahead_points[i]) - behind.gradient[i].cross(behind_points[i]);
          const Eigen::Vector2d column = frames[i].transpose() * difference / (2 * kStep);
          EXPECT_LT((t.hessian[i][j].col(axis) - column).norm(), 3e-6) << i << j;
        }
      }
    }
  }
}

template <class Spring>
double leastEigenvalue(const Spring& spring,
                       const std::array<Vector3, Spring::kParticles>& points) {
  constexpr int N = Spring::kParticles;
  const auto t = tangentCondition(spring, points, framesOf(points), Curvature::definite);
  Eigen::Matrix<double, 2 * N, 2 * N> hessian;
  for (int i = 0; i < N; ++i) {
    for (int j = 0; j < N; ++j) {
      hessian.template block<2, 2>(2 * i, 2 * j) =
          t.gradient[i] * t.gradient[j].transpose() + t.value * t.hessian[i][j];
    }
  }
  EXPECT_LT((hessian - hessian.transpose()).norm(), 1e-12 * hessian.norm());
  return Eigen::SelfAdjointEigenSolver<decltype(hessian)>(hessian).eigenvalues().minCoeff() /
         hessian.norm();
}

TYPED_TEST(Springs, DefiniteCurvatureIsDefinite) {
  Random random(6);
  for (int trial = 0; trial < 500; ++trial) {
    const auto spring = random.spring<TypeParam>({});
    const auto points = random.unitVectors<TypeParam::kParticles>();
    EXPECT_GT(leastEigenvalue(spring, points), -1e-14);
  }
}

// At an angle of 0.1 the curvature across is 2 (rest - angle) / angle of the stiffness, nearly.
TEST(AngleSpring, TemperedCurvatureIsExactBelowThreeTenthsOfTheStiffness) {
  const std::array<Vector3, 2> points = {Vector3(1, 0, 0),
                                         Vector3(std::cos(0.1), std::sin(0.1), 0)};
  const auto hessian = [&](double rest_angle, Curvature curvature) {
    const auto t = tangentCondition(testing::angleSpring(0, 1, rest_angle), points,
                                    framesOf(points), curvature);
    return t.hessian[0][0];
  };
  for (const double rest_angle : {0., 0.05, 0.1, 0.113}) {
    EXPECT_EQ(hessian(rest_angle, Curvature::tempered), hessian(rest_angle, Curvature::exact));
  }
  for (const double rest_angle : {0.117, 0.2, 3.}) {
    EXPECT_EQ(hessian(rest_angle, Curvature::tempered), hessian(rest_angle, Curvature::definite));
  }
}

TYPED_TEST(Springs, AtRestTakesThePresentValue) {
  Random random(7);
  for (int trial = 0; trial < 100; ++trial) {
    auto spring = random.spring<TypeParam>({});
    const auto points = random.unitVectors<TypeParam::kParticles>();
    rest(spring, points);
    EXPECT_EQ(condition(spring, points).value, 0);
  }
}

TEST(AngleSpring, CoincidingAndAntipodalEndsAreParted) {
  const auto spring = testing::angleSpring(0, 1, 1);
  const Vector3 a = Vector3(1, 2, 3).normalized();
  for (const Vector3& b : {Vector3(a), Vector3(-a)}) {
    const auto c = condition(spring, {a, b});
    EXPECT_NEAR(c.gradient[0].norm(), 1, 1e-15);
    EXPECT_EQ(c.gradient[0], -c.gradient[1]);
  }
}

TEST(SolidAngleSpring, EnergyIsContinuousOverTheGreatCircle) {
  for (const double rest : {1.5, -1.5}) {
    const auto spring = testing::solidAngleSpring(0, 1, 2, rest);
    for (const double side : {1e-9, -1e-9}) {
      std::array<Vector3, 3> points;
      for (int i = 0; i < 3; ++i) {
        const double turn = 2 * kPi * i / 3;
        points[i] = Vector3(std::cos(turn), std::sin(turn), side).normalized();
      }
      // The areas are 2 pi and -2 pi; modulo 4 pi they are one.
      const double expected = rest > 0 ? 2 * kPi - rest : -2 * kPi - rest;
      EXPECT_NEAR(condition(spring, points).value, expected, 1e-7) << rest << " " << side;
    }
  }
}

TEST(SolidAngleSpring, AnAntipodalPairFeelsNothing) {
  const auto spring = testing::solidAngleSpring(0, 1, 2, 1);
  const Vector3 a(1, 0, 0);
  const auto c = condition(spring, {a, -a, Vector3(0, 0, 1)});
  for (const Vector3& gradient : c.gradient) EXPECT_EQ(gradient, Vector3::Zero());
}

TEST(OrientedAngleSpring, SignFollowsTheThirdParticle) {
  OrientedAngleSpring spring;
  spring.rest_angle = 0.5;
  spring.stiffness = 1;
  const Vector3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  EXPECT_DOUBLE_EQ(condition(spring, {x, y, z}).value, kPi / 2 - 0.5);
  EXPECT_DOUBLE_EQ(condition(spring, {x, y, Vector3(-z)}).value, -kPi / 2 - 0.5);
  EXPECT_DOUBLE_EQ(effectiveWidth(spring), 0.2 * std::pow(std::sin(0.25), 2));
}

TEST(OrientedAngleSpring, OfRestAngleZeroIsAPlainOne) {
  Random random(8);
  OrientedAngleSpring oriented;
  const auto plain = testing::angleSpring(0, 1, 0);
  for (int trial = 0; trial < 100; ++trial) {
    const auto points = random.unitVectors<3>();
    const auto c = condition(oriented, points);
    const auto expected = condition(plain, {points[0], points[1]});
    EXPECT_DOUBLE_EQ(std::abs(c.value), expected.value);
    EXPECT_LT((c.value * c.gradient[0] - expected.value * expected.gradient[0]).norm(), 1e-15);
    EXPECT_EQ(c.gradient[2], Vector3::Zero());
  }
}

}  // namespace
}  // namespace spherical_springs::core
