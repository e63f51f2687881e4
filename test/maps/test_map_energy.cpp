// The energy of maps.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "maps/coverage.h"
#include "maps/map_energy.h"
#include "support/shapes.h"

namespace spherical_springs::mesh {
namespace {

using testing::shaken;
using testing::sharesOf;

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

TEST(MapEnergy, HasTheSameBitsOnAnyNumberOfThreads) {
  const TriangleMesh mesh = testing::bumps(5, 1);
  const auto evaluated = [&](int threads, FaceHessian hessian) {
    MapEnergy energy(mesh.faces, sharesOf(mesh), shaken(mesh, 1e-3), threads);
    energy.setShape(0.3);
    energy.evaluate(hessian);
    std::vector<double> numbers = {energy.value(), energy.valueAfter(-1e-9 * energy.gradient()),
                                   energy.spread()};
    numbers.insert(numbers.end(), energy.gradient().begin(), energy.gradient().end());
    for (const auto& block : energy.hessian()) {
      numbers.insert(numbers.end(), block.data(), block.data() + block.size());
    }
    return numbers;
  };
  for (const auto hessian : {FaceHessian::exact, FaceHessian::definite}) {
    const std::vector<double> expected = evaluated(1, hessian);
    for (const int threads : {2, 3}) EXPECT_TRUE(evaluated(threads, hessian) == expected);
  }
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

/// The bottom face of the tetrahedron is nearly half of the sphere.
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

}  // namespace
}  // namespace spherical_springs::mesh
