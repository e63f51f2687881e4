// Maps in one call: how they end, what they tell, and what they are as springs.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "maps/coverage.h"
#include "spherical_springs/maps/map_scene.h"
#include "spherical_springs/maps/mesh_map.h"
#include "support/shapes.h"

namespace spherical_springs::mesh {
namespace {

using testing::sharesOf;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(MeshMap, IsFoundWithinTheTolerance) {
  const TriangleMesh mesh = testing::bumps(3, 2);
  const Eigen::VectorXd shares = sharesOf(mesh);
  MapOptions options;
  options.tolerance = 0.01;
  const MeshMap map = meshMap(mesh, shares, {}, options);
  EXPECT_EQ(map.end, MapEnd::found);
  EXPECT_EQ(map.points, sphereMap(mesh, shares, options));
  EXPECT_LE(map.distortion.spread, 0.01);
  EXPECT_TRUE(coversOnce(map.distortion));
  EXPECT_EQ(map.faces.areas, faceDistortion(mesh, shares, map.points).areas);
}

TEST(MeshMap, EndsWhenTimeIsOver) {
  const TriangleMesh mesh = testing::star(4, 2, false, 5);
  MapOptions options;
  options.tolerance = 0;
  options.max_time = 0;
  EXPECT_EQ(meshMap(mesh, sharesOf(mesh), {}, options).end, MapEnd::time);
}

TEST(MeshMap, EndsWhenItIsTold) {
  const TriangleMesh mesh = testing::star(4, 2, false, 5);
  MapOptions options;
  options.tolerance = 0;
  options.go_on = [](const MapProgress& progress) { return std::isinf(progress.spread); };
  const MeshMap map = meshMap(mesh, sharesOf(mesh), {}, options);
  EXPECT_EQ(map.end, MapEnd::told);
  EXPECT_TRUE(coversOnce(mesh.faces, map.points));
}

TEST(MeshMap, TellsTheSpreadOfTheMapThatWouldComeOut) {
  const TriangleMesh mesh = testing::star(3, 2, false, 3);
  const Eigen::VectorXd shares = sharesOf(mesh);
  for (const std::size_t most : {3, 10, 100}) {
    MapOptions options;
    options.tolerance = 0;
    options.max_time = 1e6;
    std::vector<double> told;
    options.go_on = [&](const MapProgress& progress) {
      if (std::isfinite(progress.spread)) told.push_back(progress.spread);
      return told.size() < most;
    };
    const MeshMap map = meshMap(mesh, shares, {}, options);
    // The map under way may come a little further, and energies fall where spreads need not.
    EXPECT_NEAR(map.distortion.spread, told.back(), 0.2 * told.back()) << most;
    EXPECT_LT(told.back(), told.front()) << most;
  }
}

// There the spread may grow while the energy falls.
TEST(MeshMap, TellsTheSpreadWithAnAngleWeightToo) {
  const TriangleMesh mesh = testing::bumps(3, 2);
  MapOptions options;
  options.angle_weight = 3;
  double told = kInfinity;
  options.go_on = [&](const MapProgress& progress) { return told = progress.spread, true; };
  const MeshMap map = meshMap(mesh, sharesOf(mesh), {}, options);
  EXPECT_EQ(map.end, MapEnd::found);
  EXPECT_NEAR(map.distortion.spread, told, 0.01 * told);
}

TEST(MeshMap, LeavesAGoodStartAsItIs) {
  const TriangleMesh mesh = testing::bumps(2, 3);
  const Values shares = faceShares(faceAreas(mesh));
  const MeshMap map = meshMap(mesh, shares, {}, {});
  ASSERT_LE(map.distortion.spread, 1e-3);
  EXPECT_EQ(map.points, meshMap(mesh, shares, map.points, {}).points);
}

TEST(MeshMap, OfASphereIsTheSphere) {
  const TriangleMesh mesh = testing::deformedSphere(2, [](const Vector3& p) { return p; });
  MapOptions options;
  options.tolerance = 0.1;
  const MeshMap map = meshMap(mesh, faceShares(faceAreas(mesh)), {}, options);
  EXPECT_LT((map.points - mesh.vertices).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(MeshMap, TellsTheSpreadOfItsStart) {
  const TriangleMesh mesh = testing::bumps(2, 2);
  const Eigen::VectorXd shares = sharesOf(mesh);
  MapOptions options;
  options.tolerance = 100;
  double first = kInfinity;
  options.go_on = [&](const MapProgress& p) { return first = std::min(first, p.spread), true; };
  const Points start = testing::shaken(mesh, 0.01);
  const MeshMap map = meshMap(mesh, shares, start, options);
  EXPECT_NEAR(first, summary(faceDistortion(mesh, shares, start)).spread, 1e-9);
  EXPECT_EQ(map.points, start);
}

TEST(CentralProjection, IsThatFromTheMean) {
  TriangleMesh mesh = testing::bumps(2, 1);
  const Points directions = centralProjection(mesh);
  mesh.vertices.colwise() += Vector3(3, -2, 5);
  EXPECT_LT((centralProjection(mesh) - directions).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((directions.colwise().norm().array() - 1).abs().maxCoeff(), 1e-14);
  mesh.vertices.col(0) = mesh.vertices.rightCols(mesh.vertices.cols() - 1).rowwise().mean();
  EXPECT_NEAR(centralProjection(mesh).col(0).norm(), 1, 1e-14);
}

TEST(SceneOfMap, HoldsTheMap) {
  const TriangleMesh mesh = testing::bumps(1, 1);
  const Eigen::VectorXd shares = sharesOf(mesh);
  const Points map = mesh.vertices.colwise().normalized();
  const core::Scene scene = sceneOfMap(mesh.faces, shares, map, 0.1, {});
  const auto& triangles = scene.springs<core::SolidAngleSpring>();
  const auto& arcs = scene.springs<core::AngleSpring>();
  ASSERT_EQ(scene.particles().size(), 42u);
  ASSERT_EQ(triangles.size(), 80u);
  ASSERT_EQ(arcs.size(), 120u);
  EXPECT_EQ(scene.springCount(), springCountOfMap(80));
  for (std::size_t f = 0; f < 80; ++f) {
    EXPECT_EQ(triangles.item(f).rest_solid_angle, shares[f]);
    EXPECT_NEAR(triangles.item(f).stiffness * shares[f] * shares[f], 1, 1e-12);
    for (int k = 0; k < 3; ++k) EXPECT_EQ(triangles.item(f).particles[k], mesh.faces(k, f));
  }
  for (const core::AngleSpring& arc : arcs.items()) {
    const auto [from, to] = arc.particles;
    EXPECT_LT(from, to);
    EXPECT_EQ(arc.rest_angle, core::arc(map.col(from), map.col(to)).angle);
    EXPECT_NEAR(arc.stiffness * arc.rest_angle * arc.rest_angle, 0.10001, 1e-9);
  }
}

TEST(SceneOfMap, KeepsToTheLimits) {
  const TriangleMesh mesh = testing::tetrahedron();
  const Eigen::VectorXd shares = sharesOf(mesh);
  const Points map = mesh.vertices.colwise().normalized();
  EXPECT_NO_THROW(sceneOfMap(mesh.faces, shares, map, 0, {4, 10}));
  EXPECT_THROW(sceneOfMap(mesh.faces, shares, map, 0, {3, 10}), std::invalid_argument);
  EXPECT_THROW(sceneOfMap(mesh.faces, shares, map, 0, {4, 9}), std::invalid_argument);
}

}  // namespace
}  // namespace spherical_springs::mesh
