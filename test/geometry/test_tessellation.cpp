#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "geometry/tessellation.h"
#include "support/scenes.h"

namespace spherical_springs::core {
namespace {

using testing::Random;

const Vector3 kX(1, 0, 0), kY(0, 1, 0), kZ(0, 0, 1);

std::vector<Vector3> arcPieces(const Vector3& a, const Vector3& b, double longest) {
  std::vector<Vector3> ends;
  appendArc(a, b, longest, ends);
  return ends;
}

std::vector<Vector3> trianglePieces(const Vector3& a, const Vector3& b, const Vector3& c,
                                    double longest) {
  std::vector<Vector3> corners;
  appendTriangle(a, b, c, longest, corners);
  return corners;
}

double angle(const Vector3& a, const Vector3& b) { return arc(a, b).angle; }

TEST(Tessellation, ChordsOfAPieceStayWithinTheDepth) {
  for (const double depth : {1e-4, 1e-2, 1.}) {
    EXPECT_NEAR(1 - std::cos(pieceWithin(depth) / 2), depth, 1e-12);
  }
}

TEST(Tessellation, ArcsGoFromEndToEndInEqualPiecesOnTheGreatCircle) {
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    const Vector3 a = random.unitVector();
    const Vector3 b = random.unitVector();
    const double whole = angle(a, b);
    const auto ends = arcPieces(a, b, 0.1);
    ASSERT_EQ(ends.size(), 2 * static_cast<std::size_t>(std::ceil(whole / 0.1)));
    EXPECT_EQ(ends.back(), b);
    for (std::size_t j = 0; j < ends.size(); j += 2) {
      EXPECT_EQ(ends[j], j == 0 ? a : ends[j - 1]);
      EXPECT_NEAR(ends[j].norm(), 1, 1e-15);
      EXPECT_NEAR(angle(ends[j], ends[j + 1]), 2 * whole / ends.size(), 1e-14);
      EXPECT_NEAR(angle(a, ends[j]) + angle(ends[j], b), whole, 1e-7);
    }
  }
}

TEST(Tessellation, ArcsAtTheEdges) {
  EXPECT_TRUE(arcPieces(kX, kX, 0.1).empty());
  const auto ends = arcPieces(kX, -kX, 0.1);
  EXPECT_EQ(ends.size(), 2 * 32u);
  EXPECT_NEAR(angle(ends[0], ends[1]), kPi / 32, 1e-15);
}

void expectToCover(const Vector3& a, const Vector3& b, const Vector3& c, double longest,
                   std::size_t most) {
  const auto corners = trianglePieces(a, b, c, longest);
  ASSERT_LE(corners.size(), 3 * most);
  double area = 0;
  const double orientation = solidAngle(a, b, c) < 0 ? -1 : 1;
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    const double piece = solidAngle(corners[i], corners[i + 1], corners[i + 2]);
    EXPECT_GT(orientation * piece, -1e-12);
    area += piece;
    for (std::size_t j = 0; j < 3; ++j) {
      EXPECT_NEAR(corners[i + j].norm(), 1, 1e-15);
      EXPECT_LE(angle(corners[i + j], corners[i + (j + 1) % 3]), longest * (1 + 1e-12));
    }
  }
  EXPECT_NEAR(area, solidAngle(a, b, c), 1e-10);
}

TEST(Tessellation, TrianglesAreCoveredOnceByPiecesOfTheirOrientation) {
  Random random(2);
  for (int i = 0; i < 100; ++i) {
    expectToCover(random.unitVector(), random.unitVector(), random.unitVector(), 0.1, 6000);
  }
  expectToCover(kX, kY, kZ, 0.1, 2000);
  expectToCover(kX, kZ, kY, 2, 1);
}

TEST(Tessellation, TrianglesAtTheEdgesHaveFewPieces) {
  const Vector3 nearly = Vector3(-1, 1e-9, 0).normalized();
  expectToCover(kX, nearly, kZ, 0.1, 6000);
  EXPECT_LE(trianglePieces(kX, -kX, kZ, 0.1).size(), 3 * 6000u);
  EXPECT_EQ(trianglePieces(kX, kX, kX, 0.1).size(), 3u);
  const double third = 2 * kPi / 3;  // a great circle
  EXPECT_LE(trianglePieces(kX, {std::cos(third), std::sin(third), 0},
                           {std::cos(third), -std::sin(third), 0}, 0.1)
                .size(),
            3 * 6000u);
}

}  // namespace
}  // namespace spherical_springs::core
