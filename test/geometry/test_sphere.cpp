#include <gtest/gtest.h>

#include <cmath>

#include "spherical_springs/sphere.h"
#include "support/scenes.h"

namespace spherical_springs::core {
namespace {

using testing::Random;

constexpr double kUlp = 2.3e-16;

TEST(Direction, OfAnyMagnitude) {
  const Vector3 expected = Vector3(1, 2, 3).normalized();
  for (const double scale : {1e-320, 1e-300, 1e-9, 1., 1e200, 5e307}) {
    const double tolerance = scale < 1e-310 ? 1e-3 : 4 * kUlp;  // few digits are left there
    EXPECT_LT((direction(scale * Vector3(1, 2, 3)) - expected).norm(), tolerance) << scale;
  }
}

TEST(Direction, OfADirectionIsItselfToTheLastBit) {
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const Vector3 p = random.unitVector();
    EXPECT_EQ(p, direction(p));
  }
}

TEST(Arc, ShortAndNearlyAntipodal) {
  for (double angle = 1e-15; angle < 1; angle *= 10) {
    const Vector3 a(1, 0, 0);
    const Vector3 near(std::cos(angle), std::sin(angle), 0);
    EXPECT_NEAR(arc(a, near).angle / angle, 1, 4 * kUlp);
    EXPECT_EQ(arc(a, near).axis, Vector3(0, 0, 1));
    EXPECT_NEAR(arc(a, -near).angle, kPi - angle, 4 * kUlp);
    EXPECT_EQ(arc(a, -near).axis, Vector3(0, 0, -1));
  }
}

TEST(Arc, WithoutAnAxisOfItsOwn) {
  const Vector3 a = Vector3(1, 2, 3).normalized();
  for (const Vector3& b : {Vector3(a), Vector3(-a)}) {
    const Arc between = arc(a, b);
    EXPECT_DOUBLE_EQ(between.angle, b == a ? 0 : kPi);
    EXPECT_NEAR(between.axis.norm(), 1, 4 * kUlp);
    EXPECT_NEAR(between.axis.dot(a), 0, 4 * kUlp);
  }
}

TEST(SolidAngle, OfTheOctantIsAnEighthOfTheSphere) {
  const Vector3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  EXPECT_DOUBLE_EQ(solidAngle(x, y, z), kPi / 2);
  EXPECT_DOUBLE_EQ(solidAngle(x, z, y), -kPi / 2);
}

TEST(SolidAngle, IsTheAngularExcess) {
  Random random(2);
  const auto cornerAngle = [](const Vector3& at, const Vector3& p, const Vector3& q) {
    return std::acos(at.cross(p).normalized().dot(at.cross(q).normalized()));
  };
  for (int i = 0; i < 1000; ++i) {
    const auto [a, b, c] = random.unitVectors<3>();
    const double excess = cornerAngle(a, b, c) + cornerAngle(b, c, a) + cornerAngle(c, a, b) - kPi;
    const double sign = a.dot(b.cross(c)) > 0 ? 1 : -1;
    EXPECT_NEAR(solidAngle(a, b, c), sign * excess, 1e-7);
  }
}

// A right triangle with legs s on the sphere has tan(area / 2) = tan^2(s / 2).
TEST(SolidAngle, OfSmallTriangles) {
  for (double s = 1e-8; s < 1; s *= 10) {
    const Vector3 a(0, 0, 1), b(std::sin(s), 0, std::cos(s)), c(0, std::sin(s), std::cos(s));
    const double expected = 2 * std::atan(std::pow(std::tan(s / 2), 2));
    EXPECT_NEAR(solidAngle(a, b, c) / expected, 1, 1e-14) << s;
    EXPECT_NEAR(solidAngle(b, c, a) / expected, 1, 1e-14) << s;
    EXPECT_NEAR(solidAngle(c, b, a) / expected, -1, 1e-14) << s;
  }
}

// With b the antipode of a turned by s towards x, and c on y: a lune of angle s or its half.
TEST(SolidAngle, BesideAnAntipodalPair) {
  for (double s = 1e-12; s < 1; s *= 10) {
    const Vector3 a(0, 0, 1), b(std::sin(s), 0, -std::cos(s)), c(0, 1, 0);
    // z = denominator + i triple product = (1 - cos s) + i (a . b x c) with a . b x c = sin s
    const double expected = 2 * std::atan2(std::sin(s), 2 * std::pow(std::sin(s / 2), 2));
    EXPECT_NEAR(solidAngle(a, b, c), expected, 1e-15 + 1e-14 * expected) << s;
  }
}

TEST(SolidAngle, OfAnAntipodalPairCountsAsZero) {
  const Vector3 a = Vector3(1, 2, 3).normalized();
  EXPECT_EQ(solidAngle(a, -a, Vector3(0, 0, 1)), 0);
}

TEST(TripleProduct, IsAntisymmetric) {
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const auto [a, b, c] = random.unitVectors<3>();
    EXPECT_NEAR(tripleProduct(a, b, c), a.dot(b.cross(c)), 1e-15);
    EXPECT_NEAR(tripleProduct(a, b, c), -tripleProduct(b, a, c), 1e-15);
  }
}

TEST(Rotated, TurnsAboutTheVectorByItsLength) {
  Random random(4);
  for (int i = 0; i < 1000; ++i) {
    const Vector3 p = random.unitVector();
    const Vector3 axis = perpendicular(p);
    const double angle = random.between(-10, 10);
    const Vector3 q = rotated(p, angle * axis);
    EXPECT_NEAR(q.norm(), 1, 4 * kUlp);
    EXPECT_NEAR(q.dot(axis), 0, 4 * kUlp);
    EXPECT_NEAR(q.dot(p), std::cos(angle), 1e-14);
    EXPECT_NEAR(q.dot(axis.cross(p)), std::sin(angle), 1e-14);
  }
  const Vector3 p = random.unitVector();
  EXPECT_EQ(rotated(p, Vector3::Zero()), p);
}

}  // namespace
}  // namespace spherical_springs::core
