#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "spherical_springs/relaxation.h"
#include "support/relaxation_scenes.h"

namespace spherical_springs::core {
namespace {

using testing::dense;
using testing::energyAt;
using testing::positionsOf;

/// Springs of all kinds, two of the particles pinned and two more that only pinned springs join.
Scene mixedScene() {
  Scene scene = testing::chainScene(5, 24, 0);
  scene.addParticles({testing::particleAt({1, 0, 0}), testing::particleAt({0, 1, 0})});
  scene.addSprings(testing::arcs({testing::angleSpring(24, 25, 0.5)}), positionsOf(scene));
  return testing::pinnedScene(scene, {0, 9, 24, 25});
}

double valueAfter(TangentEnergy& energy, const Eigen::VectorXd& step) {
  energy.mark();
  energy.move(step);
  energy.evaluate(Curvature::exact);
  const double value = energy.value();
  energy.goBack();
  return value;
}

Eigen::VectorXd gradientAfter(TangentEnergy& energy, const Eigen::VectorXd& step) {
  valueAfter(energy, step);
  return energy.gradient();
}

TEST(TangentEnergy, ValueAndTorqueAreThoseOfTheSystem) {
  for (const Scene& scene : {mixedScene(), testing::membraneScene(2)}) {
    const System system(scene, {});
    const Points positions = positionsOf(scene);
    for (const Curvature curvature : {Curvature::exact, Curvature::definite}) {
      const auto energy = energyAt(system, positions, curvature);
      const double expected = system.potential(positions).total();
      EXPECT_NEAR(energy.energy(), expected, 1e-13 * expected);
      EXPECT_EQ(energy.unit(0), system.largestStiffness());
      EXPECT_EQ(energy.places().positions(), positions);
      System::Workspace workspace;
      system.evaluate(positions, workspace);
      double torque = 0;
      for (Eigen::Index i = 0; i < positions.cols(); ++i) {
        if (!system.pinned(i)) torque = std::max(torque, workspace.torques.col(i).norm());
      }
      EXPECT_NEAR(energy.maxTorque(), torque, 1e-12 * torque);
    }
  }
}

TEST(TangentEnergy, DerivativesAreTheSlopes) {
  const Scene scene = mixedScene();
  const System system(scene, {});
  auto energy = energyAt(system, positionsOf(scene), Curvature::exact);
  ASSERT_EQ(energy.freeCount(), 22);
  const Eigen::VectorXd gradient = energy.gradient();
  const Eigen::MatrixXd hessian = dense(energy.pattern(), energy.hessian());
  EXPECT_LT((hessian - hessian.transpose()).norm(), 1e-14 * hessian.norm());
  constexpr double kStep = 1e-5;
  for (Eigen::Index u = 0; u < gradient.size(); ++u) {
    const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(gradient.size(), u);
    const double slope = (valueAfter(energy, step) - valueAfter(energy, -step)) / (2 * kStep);
    EXPECT_NEAR(gradient[u], slope, 1e-7 * gradient.norm());
    const Eigen::VectorXd column =
        (gradientAfter(energy, step) - gradientAfter(energy, -step)) / (2 * kStep);
    EXPECT_LT((hessian.col(u) - column).norm(), 1e-6 * hessian.norm()) << u;
  }
}

TEST(TangentEnergy, ExpectedDropIsThatOfTheModel) {
  const Scene scene = mixedScene();
  const System system(scene, {});
  const auto energy = energyAt(system, positionsOf(scene), Curvature::exact);
  const Eigen::VectorXd step =
      Eigen::VectorXd::LinSpaced(2 * static_cast<Eigen::Index>(energy.freeCount()), -0.1, 0.2);
  const double expected = -step.dot(energy.gradient()) -
                          0.5 * step.dot(dense(energy.pattern(), energy.hessian()) * step);
  EXPECT_NEAR(energy.expectedDrop(step), expected, 1e-13 * std::abs(expected));
}

/// Least eigenvalue of the Hessian, relative to its norm.
double leastEigenvalue(const System& system, const Points& positions, Curvature curvature) {
  const auto energy = energyAt(system, positions, curvature);
  const Eigen::MatrixXd hessian = dense(energy.pattern(), energy.hessian());
  EXPECT_LT((hessian - hessian.transpose()).norm(), 1e-14 * hessian.norm());
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(hessian).eigenvalues()[0] / hessian.norm();
}

TEST(TangentEnergy, DefiniteHessianIsDefiniteWhereTheExactOneIsNot) {
  for (const Scene& scene : {mixedScene(), testing::membraneScene(2)}) {
    const System system(scene, {});
    const Points positions = positionsOf(scene);
    EXPECT_GT(leastEigenvalue(system, positions, Curvature::definite), -1e-15);
    EXPECT_LT(leastEigenvalue(system, positions, Curvature::exact), -1e-4);
  }
}

// One particle past others, close to one that a spring joins it with. Torques give rotations of the
// whole scene a little curvature of either sign.
TEST(TangentEnergy, TemperedHessianIsNearlyDefiniteRoundAFold) {
  const Scene scene = testing::membraneScene(2);
  const System system(scene, {});
  const Points positions = relax(system, positionsOf(scene), {}).positions;
  for (const AngleSpring& spring :
       {system.springs<AngleSpring>()[0], system.springs<AngleSpring>()[200]}) {
    const auto [a, b] = spring.particles;
    Points folded = positions;
    folded.col(a) = (0.1 * positions.col(a) + 0.9 * positions.col(b)).normalized();
    EXPECT_LT(leastEigenvalue(system, folded, Curvature::exact), -1e-2);
    EXPECT_GT(leastEigenvalue(system, folded, Curvature::tempered), -1e-4);
  }
}

TEST(TangentEnergy, MovesAlongTheSphereAndBack) {
  const Scene scene = mixedScene();
  const System system(scene, {});
  const Points start = positionsOf(scene);
  auto energy = energyAt(system, start, Curvature::exact);
  const Eigen::VectorXd gradient = energy.gradient();
  energy.mark();
  energy.move(Eigen::VectorXd::Constant(gradient.size(), 0.3));
  const Points moved = energy.places().positions();
  EXPECT_LT((moved.colwise().norm().array() - 1).abs().maxCoeff(), 1e-15);
  for (Eigen::Index i = 0; i < start.cols(); ++i) {
    // The tangent vector has the length 0.3 sqrt(2); the way back is along the radius.
    const double expected = system.pinned(i) ? 0 : std::atan(0.3 * std::sqrt(2));
    EXPECT_NEAR(arc(start.col(i), moved.col(i)).angle, expected, 1e-14);
  }
  energy.goBack();
  energy.evaluate(Curvature::exact);
  EXPECT_EQ(energy.places().positions(), start);
  EXPECT_EQ(energy.gradient(), gradient);
}

/// The springs of a ring of four, for small differences.
SpringLists ring(double rest_angle, double stiffness) {
  SpringLists springs = testing::arcs(
      {testing::angleSpring(0, 1, rest_angle), testing::angleSpring(1, 2, rest_angle),
       testing::angleSpring(2, 3, rest_angle), testing::angleSpring(3, 0, rest_angle)});
  springs.get<SolidAngleSpring>() = {testing::solidAngleSpring(0, 1, 2, rest_angle)};
  for (AngleSpring& spring : springs.get<AngleSpring>()) spring.stiffness = stiffness;
  return springs;
}

Scene ringScene(const SpringLists& springs, std::vector<std::uint32_t> pins = {},
                std::size_t count = 4) {
  std::vector<Particle> particles;
  for (std::size_t i = 0; i < count; ++i) {
    const double turn = 0.4 * static_cast<double>(i * i);
    particles.push_back(testing::particleAt({std::cos(turn), std::sin(turn), 0.3}));
  }
  return testing::pinnedScene(testing::sceneOf(particles, springs), pins);
}

TEST(TangentEnergy, HasAUnitForEachGroup) {
  SpringLists springs =
      testing::arcs({testing::angleSpring(0, 1, 0.5), testing::angleSpring(2, 3, 1),
                     testing::angleSpring(3, 4, 1), testing::angleSpring(5, 6, 1),
                     testing::angleSpring(6, 7, 1)});
  auto& arcs = springs.get<AngleSpring>();
  const double stiffness[] = {1e16, 0.5, 2, 1e15, 3e16};
  for (std::size_t i = 0; i < arcs.size(); ++i) arcs[i].stiffness = stiffness[i];
  const Scene scene = ringScene(springs, {5, 6}, 8);
  const System system(scene, {});
  const auto energy = energyAt(system, positionsOf(scene), Curvature::exact);
  double value = 0;
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    const auto c = condition(arcs[i], System::points(arcs[i], positionsOf(scene))).value;
    const double unit = i == 1 || i == 2 ? 2 : 3e16;
    if (i != 3) value += 0.5 * stiffness[i] / unit * c * c;  // which is between pins
  }
  for (std::size_t f = 0; f < energy.freeCount(); ++f) {
    const std::uint32_t i = energy.particle(f);
    EXPECT_EQ(energy.unit(f), i >= 2 && i <= 4 ? 2 : 3e16) << i;
  }
  EXPECT_NEAR(energy.value(), value, 1e-14 * value);
  const double total = system.potential(positionsOf(scene)).total();
  EXPECT_NEAR(energy.energy(), total, 1e-14 * total);
}

TEST(TangentEnergy, FitsWhatDiffersInRestAndLittleInStiffness) {
  const Scene scene = ringScene(ring(0.5, 1), {1});
  const Points positions = positionsOf(scene);
  auto energy = energyAt(System(scene, {}), positions, Curvature::exact);
  const System other(ringScene(ring(0.7, 2), {1}), {});
  ASSERT_TRUE(energy.fits(other));
  energy.take(other);
  energy.place(positions);
  energy.evaluate(Curvature::exact);
  const auto fresh = energyAt(other, positions, Curvature::exact);
  EXPECT_EQ(energy.unit(0), 2);
  EXPECT_EQ(energy.value(), fresh.value());
  EXPECT_EQ(energy.gradient(), fresh.gradient());
  EXPECT_EQ(energy.hessian(), fresh.hessian());
}

TEST(TangentEnergy, DoesNotFitOtherSpringsOrPinsOrStiffness) {
  const Scene scene = ringScene(ring(0.5, 1), {1});
  const auto energy = energyAt(System(scene, {}), positionsOf(scene), Curvature::exact);
  const auto fits = [&](const SpringLists& springs, std::vector<std::uint32_t> pins,
                        std::size_t count) {
    return energy.fits(System(ringScene(springs, pins, count), {}));
  };
  const SpringLists same = ring(0.5, 1);
  EXPECT_TRUE(fits(same, {1}, 4));
  EXPECT_FALSE(fits(same, {}, 4));
  EXPECT_FALSE(fits(same, {2}, 4));
  EXPECT_FALSE(fits(same, {1, 2}, 4));
  EXPECT_FALSE(fits(same, {1}, 5));
  EXPECT_FALSE(fits(ring(0.5, 3), {1}, 4));
  EXPECT_FALSE(fits(ring(0.5, 0.3), {1}, 4));
  SpringLists springs = same;
  springs.get<AngleSpring>()[2].particles = {2, 0};
  EXPECT_FALSE(fits(springs, {1}, 4));
  springs = same;
  std::swap(springs.get<AngleSpring>()[0].particles[0], springs.get<AngleSpring>()[0].particles[1]);
  EXPECT_FALSE(fits(springs, {1}, 4));
  springs = same;
  springs.get<AngleSpring>().pop_back();
  EXPECT_FALSE(fits(springs, {1}, 4));
  springs = same;
  springs.get<SolidAngleSpring>().push_back(testing::solidAngleSpring(1, 2, 3, 0.1));
  EXPECT_FALSE(fits(springs, {1}, 4));
  springs = same;
  springs.get<OrientedAngleSpring>() = testing::threeOrientedArcs().get<OrientedAngleSpring>();
  EXPECT_FALSE(fits(springs, {1}, 4));
}

TEST(TangentEnergy, IsTheSameToTheLastBitOnAnyNumberOfThreads) {
  const Scene scene = testing::membraneScene(5);
  const auto evaluated = [&](int threads, Curvature curvature) {
    System::Options options;
    options.threads = threads;
    const System system(scene, options);
    auto energy = energyAt(system, positionsOf(scene), curvature);
    energy.move(-0.01 * energy.gradient());
    energy.evaluate(curvature);
    return energy;
  };
  for (const Curvature curvature : {Curvature::exact, Curvature::definite}) {
    const auto expected = evaluated(1, curvature);
    for (const int threads : {2, 3}) {
      const auto energy = evaluated(threads, curvature);
      EXPECT_EQ(energy.value(), expected.value());
      EXPECT_EQ(energy.places().positions(), expected.places().positions());
      EXPECT_TRUE(energy.gradient() == expected.gradient());
      EXPECT_TRUE(energy.hessian() == expected.hessian());
      EXPECT_EQ(energy.expectedDrop(energy.gradient()), expected.expectedDrop(expected.gradient()));
    }
  }
}

}  // namespace
}  // namespace spherical_springs::core
