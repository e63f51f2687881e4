// Polygons cut into triangles that cover them once.
#include <gtest/gtest.h>

#include <cmath>

#include "spherical_springs/sphere.h"
#include "surfaces/surface.h"

namespace spherical_springs::mesh {
namespace {

PolygonMesh polygon(const std::vector<Vector3>& corners) {
  PolygonMesh mesh;
  mesh.vertices = corners;
  for (std::size_t i = 0; i < corners.size(); ++i) mesh.corners.push_back(static_cast<int>(i));
  mesh.ends = {corners.size()};
  return mesh;
}

/// Each triangle's area along the axis [m^2].
Values signedAreas(const TriangleMesh& mesh, const Vector3& axis) {
  Values areas(mesh.faces.cols());
  for (Eigen::Index f = 0; f < areas.size(); ++f) {
    const Vector3 a = mesh.vertices.col(mesh.faces(0, f)), b = mesh.vertices.col(mesh.faces(1, f)),
                  c = mesh.vertices.col(mesh.faces(2, f));
    areas[f] = (b - a).cross(c - a).dot(axis) / 2;
  }
  return areas;
}

/// Whether there are n - 2 triangles, all turning as the polygon does, which cover it once.
void expectCovered(const std::vector<Vector3>& corners, double area, const Vector3& axis) {
  const Surface surface = triangulated(polygon(corners));
  ASSERT_EQ(static_cast<Eigen::Index>(corners.size()) - 2, surface.mesh.faces.cols());
  const Values areas = signedAreas(surface.mesh, axis);
  EXPECT_GT(areas.minCoeff(), 0);
  EXPECT_NEAR(area, areas.sum(), 1e-12 * std::max(1., area));
}

TEST(Triangulation, CutsAQuadrilateralAlongItsShorterDiagonal) {
  const Surface surface = triangulated(polygon({{0, 0, 0}, {3, 0, 0}, {4, 1, 0}, {1, 1, 0}}));
  const Faces& found = surface.mesh.faces;
  ASSERT_EQ(2, found.cols());
  const auto has = [&](int v, int f) { return (found.col(f).array() == v).any(); };
  for (const int f : {0, 1}) EXPECT_TRUE(has(1, f) && has(3, f)) << f;
  EXPECT_EQ((std::vector<std::int32_t>{0, 0}), surface.file_faces);
}

TEST(Triangulation, CoversPolygonsThatAreNotConvex) {
  const std::vector<Vector3> arrow = {{0, 0, 0}, {2, 1, 0}, {0, 2, 0}, {0.5, 1, 0}};
  expectCovered(arrow, 1.5, Vector3::UnitZ());
  std::vector<Vector3> comb;
  for (int i = 0; i < 20; ++i) {
    comb.push_back({2. * i, 0, 0});
    comb.push_back({2. * i + 1, 5, 0});
  }
  comb.push_back({39, -1, 0});
  comb.push_back({0, -1, 0});
  double area = 0;
  for (std::size_t i = 0; i < comb.size(); ++i) {
    const Vector3 &p = comb[i], &q = comb[(i + 1) % comb.size()];
    area -= (p[0] * q[1] - p[1] * q[0]) / 2;
  }
  expectCovered(comb, area, -Vector3::UnitZ());
}

TEST(Triangulation, CutsOffNoCornerThatAnotherReachesInto) {
  const std::vector<Vector3> spike = {{0, 0, 0},    {1, -10, 0}, {2, 0, 0},    {3, 20, 0},
                                      {1.5, 20, 0}, {1, -5, 0},  {0.5, 20, 0}, {-1, 20, 0}};
  // A trapezium and a triangle below, without the spike.
  expectCovered(spike, 60 + 10 - 12.5, Vector3::UnitZ());
}

TEST(Triangulation, CutsOffNoTriangleWithoutAreaWhereOthersAreThere) {
  expectCovered({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}, 4, Vector3::UnitZ());
}

TEST(Triangulation, OfAStarTurnedAndOfManyCorners) {
  for (const int corners : {7, 20'000}) {
    std::vector<Vector3> star;
    const Eigen::Quaterniond turn = Eigen::Quaterniond(0.3, -0.5, 0.7, 0.2).normalized();
    for (int i = 0; i < corners; ++i) {
      const double angle = 2 * core::kPi * i / corners, radius = i % 2 == 1 ? 1 : 0.7;
      star.push_back(turn * Vector3(radius * std::cos(angle), radius * std::sin(angle), 3));
    }
    double area = 0;
    for (std::size_t i = 0; i < star.size(); ++i) {
      area += star[i].cross(star[(i + 1) % star.size()]).dot(turn * Vector3::UnitZ()) / 2;
    }
    expectCovered(star, area, turn * Vector3::UnitZ());
  }
}

TEST(Triangulation, OfPointsOnALineHasItsCornersAtLeast) {
  const Surface surface =
      triangulated(polygon({{0, 0, 0}, {1, 0, 0}, {3, 0, 0}, {2, 0, 0}, {5, 0, 0}}));
  EXPECT_EQ(3, surface.mesh.faces.cols());
}

}  // namespace
}  // namespace spherical_springs::mesh
