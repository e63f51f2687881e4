// Maps of meshes to the sphere.
#include <gtest/gtest.h>

#include <limits>

#include "maps/coverage.h"
#include "spherical_springs/maps/sphere_map.h"
#include "support/hub_shapes.h"

namespace spherical_springs::mesh {
namespace {

using testing::shaken;
using testing::sharesOf;

double spread(const TriangleMesh& mesh, const Eigen::VectorXd& shares, const Points& points) {
  Eigen::ArrayXd logs(shares.size());
  for (Eigen::Index f = 0; f < shares.size(); ++f) {
    logs[f] = std::log(core::solidAngle(points.col(mesh.faces(0, f)), points.col(mesh.faces(1, f)),
                                        points.col(mesh.faces(2, f))) /
                       shares[f]);
  }
  return std::sqrt((logs - logs.mean()).square().mean());
}

MapOptions patient(double tolerance) {
  MapOptions options;
  options.tolerance = tolerance;
  options.max_time = 300;
  return options;
}

TEST(SphereMap, OfFiftyShapesDoesNotFoldAndHasTheAreas) {
  constexpr double kEnough = 0.1;
  for (const auto& shape : testing::fiftyShapes()) {
    const Eigen::VectorXd shares = sharesOf(shape.mesh);
    const Points points = sphereMap(shape.mesh, shares, patient(kEnough));
    EXPECT_TRUE(coversOnce(shape.mesh.faces, points)) << shape.name;
    EXPECT_LT(spread(shape.mesh, shares, points), kEnough) << shape.name;
  }
}

TEST(SphereMap, OfAHeadLikeShapeIsWithinTheTolerance) {
  const TriangleMesh mesh = testing::bumps(4, 4);
  const Eigen::VectorXd shares = sharesOf(mesh);
  EXPECT_LT(spread(mesh, shares, sphereMap(mesh, shares, patient(1e-3))), 1e-3);
}

TEST(SphereMap, OfTheSmallestMesh) {
  const Eigen::VectorXd shares = faceShares(Eigen::Vector4d(1, 2, 3, 4));
  const Points points = sphereMap(testing::tetrahedron(), shares, patient(5e-5));
  EXPECT_TRUE(coversOnce(testing::tetrahedron().faces, points));
  EXPECT_LT(spread(testing::tetrahedron(), shares, points), 1e-4);
}

// With a shape term a descent reaches the minimum to within rounding, and must end there.
TEST(SphereMap, OfTetrahedraWithRandomAreas) {
  testing::Random random(3);
  const TriangleMesh mesh = testing::tetrahedron();
  MapOptions options = patient(1e-5);
  options.max_time = 10;
  for (int i = 0; i < 60; ++i) {
    Eigen::Vector4d areas;
    for (int k = 0; k < 4; ++k) areas[k] = random.between(0.3, 1);
    const Eigen::VectorXd shares = faceShares(areas);
    EXPECT_LT(spread(mesh, shares, sphereMap(mesh, shares, options)), 2e-5) << areas.transpose();
  }
}

TEST(SphereMap, OfASphereFromItselfIsItself) {
  const TriangleMesh mesh = testing::deformedSphere(3, [](const Vector3& p) { return p; });
  Eigen::VectorXd shares(mesh.faces.cols());
  for (Eigen::Index f = 0; f < shares.size(); ++f) {
    shares[f] =
        core::solidAngle(mesh.vertices.col(mesh.faces(0, f)), mesh.vertices.col(mesh.faces(1, f)),
                         mesh.vertices.col(mesh.faces(2, f)));
  }
  EXPECT_EQ(sphereMap(mesh, shares, mesh.vertices, patient(1e-9)), mesh.vertices);
}

// Two vertices on one spot, and a face of a third of the area, which does not become less than half
// of the sphere in the start without it.
TEST(SphereMap, OfAnOctahedronWhoseLargestFaceStaysLarge) {
  const TriangleMesh mesh = testing::meshOf(
      {{2, 0, 0}, {-1, 0, 0}, {0, 2, 0}, {0, -1, 0}, {0, -1, 0}, {0, 0, 0.5}},
      {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}});
  const Points points = sphereMap(mesh, sharesOf(mesh), patient(1e-3));
  EXPECT_TRUE(coversOnce(mesh.faces, points));
  EXPECT_LT(spread(mesh, sharesOf(mesh), points), 1e-3);
}

// The cut face becomes one again only with shares that differ less; from there the true ones
// follow.
TEST(SphereMap, OfFewFacesWithSharesOverNineDecades) {
  testing::Random random(3);
  for (int trial = 0; trial < 12; ++trial) {
    const TriangleMesh mesh =
        trial % 3 == 0 ? testing::tetrahedron() : testing::bumps(trial % 3 - 1, 1);
    Eigen::VectorXd areas(mesh.faces.cols());
    for (Eigen::Index f = 0; f < areas.size(); ++f) areas[f] = std::pow(10, random.between(-9, 0));
    const Eigen::VectorXd shares = faceShares(areas);
    if (shares.maxCoeff() > 0.4 * 4 * core::kPi) continue;
    Points points;
    EXPECT_NO_THROW(points = sphereMap(mesh, shares, patient(100))) << trial;
    if (points.size() == 0) continue;
    EXPECT_TRUE(coversOnce(mesh.faces, points)) << trial;
  }
}

TEST(SphereMap, GoesOnFromAStart) {
  const TriangleMesh mesh = testing::bumps(3, 2);
  const Eigen::VectorXd shares = sharesOf(mesh);
  const Points start = 7 * shaken(mesh, 0.01);
  ASSERT_GT(spread(mesh, shares, start.colwise().normalized()), 0.05);
  const Points points = sphereMap(mesh, shares, start, patient(1e-3));
  EXPECT_TRUE(coversOnce(mesh.faces, points));
  EXPECT_LT(spread(mesh, shares, points), 1e-3);
  EXPECT_LT((points - shaken(mesh, 0.01)).colwise().norm().mean(), 0.5) << "it began elsewhere";
}

TEST(SphereMap, PassesOverAFoldedStart) {
  const TriangleMesh mesh = testing::star(3, 2, false, 3);
  const Eigen::VectorXd shares = sharesOf(mesh);
  Points start = mesh.vertices.colwise().normalized();
  start.col(3) = -start.col(3);
  ASSERT_FALSE(coversOnce(mesh.faces, start));
  const Points points = sphereMap(mesh, shares, start, patient(0.03));
  EXPECT_TRUE(coversOnce(mesh.faces, points));
}

TEST(SphereMap, TakesFacesWithoutArea) {
  TriangleMesh mesh = testing::bumps(3, 1);
  mesh.vertices.col(mesh.faces(0, 9)) = mesh.vertices.col(mesh.faces(1, 9));
  const Eigen::VectorXd shares = sharesOf(mesh);
  const Points points = sphereMap(mesh, shares, patient(0.05));
  EXPECT_TRUE(coversOnce(mesh.faces, points));
  EXPECT_LT(spread(mesh, shares, points), 0.05);
}

TEST(SphereMap, EndsWithAMapWhenTimeIsOver) {
  const TriangleMesh mesh = testing::star(4, 2, false, 5);
  MapOptions options;
  options.max_time = 0;
  EXPECT_TRUE(coversOnce(mesh.faces, sphereMap(mesh, sharesOf(mesh), options)));
}

TEST(SphereMap, EndsWithAMapWhenItIsCancelled) {
  const TriangleMesh mesh = testing::star(4, 2, false, 5);
  MapOptions options = patient(0);
  int calls = 0;
  options.go_on = [&](const MapProgress&) { return ++calls != 5; };
  EXPECT_TRUE(coversOnce(mesh.faces, sphereMap(mesh, sharesOf(mesh), options)));
  EXPECT_LT(calls, 100);
}

// Also in the middle of an iteration, which takes several checks here.
TEST(SphereMap, EndsWithAMapWhereverItIsCancelled) {
  const TriangleMesh mesh = testing::star(5, 2, false, 5);
  const Eigen::VectorXd shares = sharesOf(mesh);
  for (const int most : {1, 10, 50, 100}) {
    MapOptions options = patient(0);
    int calls = 0;
    options.go_on = [&](const MapProgress&) { return ++calls < most; };
    EXPECT_TRUE(coversOnce(mesh.faces, sphereMap(mesh, shares, options))) << most;
  }
}

TEST(SphereMap, OfVerticesOfManyFaces) {
  for (const auto& shape : testing::shapesWithHubs(20'000)) {
    MapOptions options;
    options.max_time = 2;
    const Points points = sphereMap(shape.mesh, sharesOf(shape.mesh), options);
    EXPECT_TRUE(coversOnce(shape.mesh.faces, points)) << shape.name;
  }
}

// Shares that differ this much need many iterations before the first map.
TEST(SphereMap, AsksWhetherToGoOnWhileThereIsNoMap) {
  const TriangleMesh mesh = testing::bumps(1, 8);
  Eigen::VectorXd areas = faceAreas(mesh);
  for (Eigen::Index f = 1; f < areas.size(); f += 2) areas[f] *= 1e-9;
  MapOptions options;
  options.max_time = 0;
  int calls = 0;
  options.go_on = [&](const MapProgress&) { return ++calls > 0; };
  sphereMap(mesh, faceShares(areas), options);
  EXPECT_GT(calls, 100);
}

TEST(SphereMap, EndsWithoutAMapWhereGoOnThrows) {
  const TriangleMesh mesh = testing::star(4, 2, false, 5);
  MapOptions options;
  options.max_time = 0;
  options.go_on = [](const MapProgress& progress) -> bool {
    EXPECT_EQ(progress.fraction, 1);
    throw std::domain_error("enough");
  };
  EXPECT_THROW(sphereMap(mesh, sharesOf(mesh), options), std::domain_error);
}

TEST(SphereMap, DoesNotDependOnThreads) {
  const TriangleMesh mesh = testing::star(5, 2, false, 3);
  const Eigen::VectorXd shares = sharesOf(mesh);
  MapOptions options = patient(0.1);
  const Points one = sphereMap(mesh, shares, options);
  options.threads = 3;
  EXPECT_EQ(sphereMap(mesh, shares, options), one);
}

TEST(SphereMap, KeepsShapeAsAsked) {
  const TriangleMesh mesh = testing::bumps(3, 2);
  const Eigen::VectorXd shares = sharesOf(mesh);
  MapOptions options = patient(1e-3);
  const double least = spread(mesh, shares, sphereMap(mesh, shares, options));
  options.angle_weight = 0.1;
  const double some = spread(mesh, shares, sphereMap(mesh, shares, options));
  options.angle_weight = 10;
  const double more = spread(mesh, shares, sphereMap(mesh, shares, options));
  EXPECT_LT(10 * least, some);
  EXPECT_LT(2 * some, more);
}

TEST(SphereMap, RefusesFaultyArguments) {
  const TriangleMesh mesh = testing::bumps(2, 1);
  const Eigen::VectorXd shares = sharesOf(mesh);
  EXPECT_THROW(sphereMap(mesh, shares.head(5)), std::invalid_argument);
  EXPECT_THROW(sphereMap(mesh, -shares), std::invalid_argument);
  EXPECT_THROW(sphereMap(testing::tetrahedron(), faceShares(Eigen::Vector4d(1, 1, 1, 3))),
               std::invalid_argument);
  EXPECT_THROW(sphereMap(mesh, shares, mesh.vertices.leftCols(5)), std::invalid_argument);
  EXPECT_THROW(sphereMap(mesh, shares, Points::Zero(3, mesh.vertices.cols())),
               std::invalid_argument);
  MapOptions options;
  options.angle_weight = -1;
  EXPECT_THROW(sphereMap(mesh, shares, options), std::invalid_argument);
  options = {};
  options.tolerance = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(sphereMap(mesh, shares, options), std::invalid_argument);
  options = {};
  options.threads = 0;
  EXPECT_THROW(sphereMap(mesh, shares, options), std::invalid_argument);
}

// Areas alone would let edges come as near to pi as rounding tells.
TEST(SphereMap, KeepsEdgesBelowPi) {
  const TriangleMesh mesh = testing::bumps(0, 8);
  Eigen::VectorXd areas = faceAreas(mesh);
  for (Eigen::Index f = 1; f < 20; f += 2) areas[f] *= 1e-9;
  const Points map = sphereMap(mesh, faceShares(areas), patient(1e-3));
  for (Eigen::Index f = 0; f < 20; ++f) {
    for (int k = 0; k < 3; ++k) {
      const Vector3 a = map.col(mesh.faces(k, f)), b = map.col(mesh.faces((k + 1) % 3, f));
      EXPECT_GT((a + b).norm(), 1e-5);
    }
  }
}

}  // namespace
}  // namespace spherical_springs::mesh
