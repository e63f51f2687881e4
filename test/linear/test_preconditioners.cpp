// Multigrid, Cholesky factorisation and the conjugate gradients that they serve.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>

#include "linear/conjugate_gradients.h"
#include "linear/multifrontal_cholesky.h"
#include "linear/multigrid.h"
#include "support/relaxation_scenes.h"

namespace spherical_springs::core {
namespace {

using testing::dense;
using testing::energyAt;
using testing::positionsOf;

/// A scene's Hessian with a share of the diagonal added.
template <class Real>
struct Matrix {
  TangentEnergy energy;
  Blocks<Real, 2> values;

  Matrix(const Scene& scene, Curvature curvature, double share)
      : energy(energyAt(System(scene, {}), positionsOf(scene), curvature)) {
    const BlockPattern& pattern = energy.pattern();
    for (const auto& block : energy.hessian()) values.push_back(block.template cast<Real>());
    for (const std::uint32_t place : pattern.diagonal) {
      const double stiffness = std::max(0.5 * energy.hessian()[place].trace(), 1e-3);
      values[place].diagonal().array() += static_cast<Real>(share * stiffness);
    }
  }
  const BlockPattern& pattern() const { return energy.pattern(); }
  Eigen::Index size() const { return static_cast<Eigen::Index>(2 * pattern().rows()); }
  Multigrid<Real> multigrid(int threads = 1) const {
    return Multigrid<Real>(pattern(), values, energy.places().rotations<Real>(), threads);
  }
};

Eigen::VectorXd randomVector(Eigen::Index size, unsigned seed) {
  testing::Random random(seed);
  Eigen::VectorXd result(size);
  for (Eigen::Index i = 0; i < result.size(); ++i) result[i] = random.between(-1, 1);
  return result;
}

Eigen::MatrixXd matrixOf(Preconditioner<double>& preconditioner, Eigen::Index size) {
  Eigen::MatrixXd result(size, size);
  Eigen::VectorXd column(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    preconditioner.apply(Eigen::VectorXd::Unit(size, i), column);
    result.col(i) = column;
  }
  return result;
}

/// Arcs between a particle and one of those before it, the first one in a star.
Scene treeScene(std::uint32_t count, bool star) {
  testing::Random random(1);
  std::vector<Particle> particles;
  SpringLists springs;
  for (std::uint32_t i = 0; i < count; ++i) {
    particles.push_back(testing::particleAt(random.unitVector()));
    if (i > 0) {
      springs.get<AngleSpring>().push_back(
          testing::angleSpring(star ? 0 : random.below(i), i, random.between(0.1, 2)));
    }
  }
  return testing::sceneOf(particles, springs);
}

std::vector<Scene> scenes() {
  return {testing::membraneScene(3),
          testing::pinnedScene(testing::membraneScene(2), {0, 1, 2, 50, 70, 71}),
          testing::chainScene(1, 400, 0),
          testing::randomScene(1, 400, 200),
          treeScene(400, true),
          treeScene(400, false),
          testing::chainScene(2, 8, 0)};
}

TEST(Multigrid, IsSymmetricAndDefinite) {
  int number = 0;
  for (const Scene& scene : scenes()) {
    SCOPED_TRACE("scene " + std::to_string(number++));
    const Matrix<double> matrix(scene, Curvature::definite, 1e-6);
    auto multigrid = matrix.multigrid();
    const Eigen::MatrixXd inverse = matrixOf(multigrid, matrix.size());
    // The smoother's own shift of 1e-9 makes it so.
    EXPECT_LT((inverse - inverse.transpose()).norm(), 1e-7 * inverse.norm());
    const Eigen::LLT<Eigen::MatrixXd> factor(dense(matrix.pattern(), matrix.values));
    const Eigen::MatrixXd lower = factor.matrixL();
    // The eigenvalues of inverse times matrix.
    const Eigen::MatrixXd product = lower.transpose() * inverse * lower;
    const Eigen::VectorXd eigenvalues =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(product, Eigen::EigenvaluesOnly)
            .eigenvalues();
    EXPECT_GT(eigenvalues.minCoeff(), 0);
  }
}

TEST(Multigrid, IsTheSameToTheLastBitOnAnyNumberOfThreads) {
  const Matrix<float> matrix(testing::membraneScene(5), Curvature::definite, 1e-6);
  const VectorOf<float> right = randomVector(matrix.size(), 1).cast<float>();
  VectorOf<float> expected(matrix.size()), solution(matrix.size());
  matrix.multigrid(1).apply(right, expected);
  for (const int threads : {2, 3}) {
    matrix.multigrid(threads).apply(right, solution);
    EXPECT_TRUE(solution == expected);
  }
}

template <class Real>
ModelMinimum minimumOf(const Matrix<Real>& matrix, Preconditioner<Real>& preconditioner,
                       const Eigen::VectorXd& gradient, double tolerance, int threads = 1) {
  return minimise(matrix.pattern(), matrix.values, preconditioner, gradient,
                  Eigen::VectorXd::Ones(gradient.size() / 2), tolerance, 300, threads);
}

// From 642 particles to 40,962.
TEST(Multigrid, NeedsAsManyIterationsWhateverTheSize) {
  int fewest = 1000, most = 0;
  for (int level = 3; level <= 6; ++level) {
    const Matrix<float> matrix(testing::membraneScene(level), Curvature::definite, 1e-6);
    auto multigrid = matrix.multigrid();
    const auto found = minimumOf(matrix, multigrid, matrix.energy.gradient(), 1e-4);
    EXPECT_FALSE(found.indefinite);
    EXPECT_LE(found.residual, 1e-4);
    fewest = std::min(fewest, found.iterations);
    most = std::max(most, found.iterations);
  }
  EXPECT_LE(most, 40);
  EXPECT_LE(most, 1.5 * fewest);
}

TEST(Multigrid, GoesOnServingAfterARefresh) {
  const Matrix<double> matrix(testing::membraneScene(4), Curvature::definite, 1e-6);
  auto softer = matrix;
  for (auto& block : softer.values) block *= 0.5;
  auto multigrid = matrix.multigrid();
  const auto before = minimumOf(matrix, multigrid, matrix.energy.gradient(), 1e-6);
  ASSERT_TRUE(multigrid.refresh(softer.values));
  const auto after = minimumOf(softer, multigrid, matrix.energy.gradient(), 1e-6);
  EXPECT_LE(after.residual, 1e-6);
  EXPECT_LE(after.iterations, 2 * before.iterations);
}

TEST(MultifrontalCholesky, IsTheInverse) {
  std::vector<Scene> all = scenes();
  all.push_back(testing::randomScene(3, 400, 200));  // of many pieces
  for (const Scene& scene : all) {
    const Matrix<double> matrix(scene, Curvature::definite, 1e-2);
    MultifrontalCholesky cholesky(matrix.pattern(), 1);
    ASSERT_TRUE(cholesky.refresh(matrix.values));
    const Eigen::VectorXd right = randomVector(matrix.size(), 2);
    Eigen::VectorXd solution(matrix.size());
    cholesky.apply(right, solution);
    const Eigen::VectorXd expected = dense(matrix.pattern(), matrix.values).llt().solve(right);
    EXPECT_LT((solution - expected).norm(), 1e-11 * expected.norm());
    EXPECT_GE(cholesky.work(), static_cast<double>(matrix.size()));
  }
}

TEST(MultifrontalCholesky, FindsAMatrixThatIsNotDefinite) {
  const Matrix<double> matrix(testing::membraneScene(2), Curvature::exact, 0);
  MultifrontalCholesky cholesky(matrix.pattern(), 1);
  EXPECT_FALSE(cholesky.refresh(matrix.values));
  EXPECT_TRUE(cholesky.refresh(
      Matrix<double>(testing::membraneScene(2), Curvature::definite, 1e-3).values));
}

TEST(ConjugateGradients, SolveToTheTolerance) {
  for (const Scene& scene : scenes()) {
    const Matrix<double> matrix(scene, Curvature::definite, 1e-3);
    auto multigrid = matrix.multigrid();
    const Eigen::VectorXd gradient = randomVector(matrix.size(), 3);
    const auto found = minimumOf(matrix, multigrid, gradient, 1e-6);
    EXPECT_FALSE(found.indefinite);
    const Eigen::MatrixXd full = dense(matrix.pattern(), matrix.values);
    const double left = (full * found.step + gradient).norm() / gradient.norm();
    EXPECT_LE(left, 1.01e-6);
    EXPECT_NEAR(left, found.residual, 1e-8);
  }
}

TEST(ConjugateGradients, ReportADirectionOfNegativeCurvature) {
  for (const Scene& scene : {testing::membraneScene(2), testing::randomScene(1, 400, 200)}) {
    const Matrix<double> exact(scene, Curvature::exact, 0);
    const Matrix<double> definite(scene, Curvature::definite, 1e-6);
    const Eigen::VectorXd& gradient = exact.energy.gradient();
    const Eigen::MatrixXd full = dense(exact.pattern(), exact.values);
    auto multigrid = definite.multigrid();
    const auto found = minimumOf(exact, multigrid, gradient, 1e-10);
    ASSERT_TRUE(found.indefinite);
    ASSERT_EQ(found.downward.size(), exact.size());
    EXPECT_LT(found.downward.dot(full * found.downward), 0);
    // Down the slope of the model, too, from where they had come to.
    EXPECT_LE(found.step.dot(gradient), 0);
    EXPECT_LT(found.downward.dot(full * found.step + gradient), 0);
  }
}

}  // namespace
}  // namespace spherical_springs::core
