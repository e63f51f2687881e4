// Maps of meshes to the sphere.
#include <gtest/gtest.h>

#include <limits>

#include "mesh/coverage.h"
#include "mesh/map_energy.h"
#include "shapes.h"
#include "spherical_springs/mesh/sphere_map.h"

namespace spherical_springs::mesh {
namespace {

Eigen::VectorXd sharesOf(const TriangleMesh& mesh) { return faceShares(faceAreas(mesh)); }

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
  options.max_time = 1e6;
  return options;
}

/// Directions of vertices of a mesh that is seen whole from its centre, shaken.
Points shaken(const TriangleMesh& mesh, double share) {
  testing::Random random(3);
  Points points = mesh.vertices.colwise().normalized();
  for (Eigen::Index v = 0; v < points.cols(); ++v) {
    points.col(v) = (points.col(v) + share * random.unitVector()).normalized();
  }
  return points;
}

void expectDerivativesAgreeWithDifferences(MapEnergy& energy) {
  energy.evaluate(FaceHessian::exact);
  const Eigen::VectorXd gradient = energy.gradient();
  const auto hessian = energy.hessian();
  const core::Graph& graph = energy.pattern().graph;
  constexpr double kStep = 1e-4;
  for (std::size_t i = 0; i < energy.pattern().rows(); ++i) {
    for (std::uint32_t e = graph.first[i]; e < graph.first[i + 1]; ++e) {
      for (int r = 0; r < 2; ++r) {
        for (int c = 0; c < 2; ++c) {
          const auto at = [&](double x, double y) {
            Eigen::VectorXd step = Eigen::VectorXd::Zero(gradient.size());
            step[2 * i + r] += x;
            step[2 * graph.neighbours[e] + c] += y;
            return energy.valueAfter(step);
          };
          const double mixed =
              (at(kStep, kStep) - at(kStep, -kStep) - at(-kStep, kStep) + at(-kStep, -kStep)) /
              (4 * kStep * kStep);
          EXPECT_NEAR(hessian[e](r, c), mixed, 1e-3 * (1 + std::abs(mixed)));
          EXPECT_NEAR(gradient[2 * i + r], (at(kStep, 0) - at(-kStep, 0)) / (2 * kStep),
                      1e-4 * (1 + gradient.cwiseAbs().maxCoeff()));
        }
      }
    }
  }
}

TEST(MapEnergy, DerivativesAgreeWithDifferences) {
  const TriangleMesh mesh = testing::bumps(1, 1);
  MapEnergy energy(mesh.faces, sharesOf(mesh), shaken(mesh, 0.05), 1);
  energy.setShape(0.3);
  expectDerivativesAgreeWithDifferences(energy);
}

TEST(MapEnergy, OfSquaresHasDerivativesAtFoldsToo) {
  const TriangleMesh mesh = testing::bumps(1, 1);
  MapEnergy energy(mesh.faces, sharesOf(mesh), shaken(mesh, 0.6), 1);
  EXPECT_EQ(energy.valueHere(), std::numeric_limits<double>::infinity());
  energy.setCost(AreaCost::square);
  expectDerivativesAgreeWithDifferences(energy);
}

/// Where areas are wrong it leaves their second derivatives out.
TEST(MapEnergy, OfGaussAndNewtonIsTheHessianWhereAreasAreRight) {
  const TriangleMesh mesh = testing::bumps(1, 1);
  const Points points = shaken(mesh, 0.05);
  const auto differenceOfHessians = [&](const Eigen::VectorXd& shares) {
    MapEnergy energy(mesh.faces, shares, points, 1);
    energy.evaluate(FaceHessian::exact);
    const MapEnergy::Hessian exact = energy.hessian();
    energy.evaluate(FaceHessian::gauss_newton);
    double largest = 0;
    for (std::size_t e = 0; e < exact.size(); ++e) {
      largest = std::max(largest, (exact[e] - energy.hessian()[e]).norm() / exact[e].norm());
    }
    return largest;
  };
  Eigen::VectorXd areas(mesh.faces.cols());
  for (Eigen::Index f = 0; f < areas.size(); ++f) {
    areas[f] = core::solidAngle(points.col(mesh.faces(0, f)), points.col(mesh.faces(1, f)),
                                points.col(mesh.faces(2, f)));
  }
  EXPECT_LT(differenceOfHessians(areas), 1e-12);
  EXPECT_GT(differenceOfHessians(sharesOf(mesh)), 1e-2);
}

TEST(MapEnergy, SweepsLowerItToWhereNoVertexCanAlone) {
  const TriangleMesh mesh = testing::bumps(2, 1);
  MapEnergy energy(mesh.faces, sharesOf(mesh), shaken(mesh, 0.05), 1);
  energy.setShape(0.3);
  const auto largestGradient = [&] {
    energy.evaluate(FaceHessian::exact);
    return energy.gradient().cwiseAbs().maxCoeff();
  };
  const double before = largestGradient();
  double value = energy.value();
  for (int i = 0; i < 200; ++i) {
    energy.sweep();
    energy.evaluate(FaceHessian::exact);
    EXPECT_LE(energy.value(), value * (1 + 1e-12));
    value = energy.value();
  }
  EXPECT_LT(largestGradient(), 1e-3 * before);
  EXPECT_TRUE(coversOnce(mesh.faces, energy.points()));
}

TEST(MapEnergy, SweepsGiveTheSameBitsOnAnyNumberOfThreads) {
  const TriangleMesh mesh = testing::bumps(5, 1);
  const auto swept = [&](int threads) {
    MapEnergy energy(mesh.faces, sharesOf(mesh), shaken(mesh, 1e-3), threads);
    energy.setShape(0.3);
    energy.sweep();
    return energy.points();
  };
  const Points expected = swept(1);
  EXPECT_TRUE(expected != mesh.vertices);
  for (const int threads : {2, 3}) EXPECT_TRUE(swept(threads) == expected) << threads;
}

TEST(MapEnergy, IsInfiniteAtAFold) {
  const TriangleMesh mesh = testing::bumps(2, 1);
  MapEnergy energy(mesh.faces, sharesOf(mesh), shaken(mesh, 0), 1);
  Eigen::VectorXd step = Eigen::VectorXd::Zero(energy.gradient().size());
  EXPECT_LT(energy.valueAfter(step), 1e6);
  step[20] = 1;
  EXPECT_EQ(energy.valueAfter(step), std::numeric_limits<double>::infinity());
  energy.setCost(AreaCost::square);
  EXPECT_LT(energy.valueAfter(step), 1e6);
}

/// Of which the bottom is nearly half of the sphere.
TEST(MapEnergy, IsInfiniteAtAFaceOfHalfOfTheSphere) {
  const TriangleMesh mesh = testing::tetrahedron();
  const auto at = [&](double depth) {
    Points points(3, 4);
    points.col(0) << 0, 0, 1;
    for (int k = 0; k < 3; ++k) {
      const double angle = 2 * core::kPi * k / 3;
      points.col(k + 1) = Vector3(std::cos(angle), std::sin(angle), -depth).normalized();
    }
    MapEnergy energy(mesh.faces, faceShares(Eigen::VectorXd::Ones(4)), points, 1);
    energy.setShape(1);
    return energy.valueAfter(Eigen::VectorXd::Zero(8));
  };
  EXPECT_LT(at(0.3), 100);
  EXPECT_GT(at(1e-3), 1e4);
  EXPECT_GT(at(1e-5), 1e8);
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
  const Points points = sphereMap(testing::tetrahedron(), shares, patient(1e-6));
  EXPECT_TRUE(coversOnce(testing::tetrahedron().faces, points));
  EXPECT_LT(spread(testing::tetrahedron(), shares, points), 1e-4);
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
  options.go_on = [&](double) { return ++calls != 5; };
  EXPECT_TRUE(coversOnce(mesh.faces, sphereMap(mesh, sharesOf(mesh), options)));
  EXPECT_LT(calls, 100);
}

// Shares that differ this much need many iterations before the first map.
TEST(SphereMap, AsksWhetherToGoOnWhileThereIsNoMap) {
  const TriangleMesh mesh = testing::bumps(1, 8);
  Eigen::VectorXd areas = faceAreas(mesh);
  for (Eigen::Index f = 1; f < areas.size(); f += 2) areas[f] *= 1e-9;
  MapOptions options;
  options.max_time = 0;
  int calls = 0;
  options.go_on = [&](double) { return ++calls > 0; };
  sphereMap(mesh, faceShares(areas), options);
  EXPECT_GT(calls, 100);
}

TEST(SphereMap, EndsWithoutAMapWhereGoOnThrows) {
  const TriangleMesh mesh = testing::star(4, 2, false, 5);
  MapOptions options;
  options.max_time = 0;
  options.go_on = [](double fraction) -> bool {
    EXPECT_EQ(fraction, 1);
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
