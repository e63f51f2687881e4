// Places without torque that are no minima, and minima among such places.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <vector>

#include "relaxation/negative_curvature.h"
#include "spherical_springs/relaxation.h"
#include "support/relaxation_scenes.h"

namespace spherical_springs::core {
namespace {

using testing::angleSpring;
using testing::positionsOf;

AngleSpring stiffSpring(std::uint32_t a, std::uint32_t b, double rest_angle, double stiffness) {
  AngleSpring spring = angleSpring(a, b, rest_angle);
  spring.stiffness = stiffness;
  return spring;
}

OrientedAngleSpring orientedSpring(std::array<std::uint32_t, 3> particles, double rest_angle,
                                   double stiffness) {
  OrientedAngleSpring spring;
  spring.particles = particles;
  spring.rest_angle = rest_angle;
  spring.stiffness = stiffness;
  return spring;
}

RelaxationResult relaxedBy(RelaxationMethod method, const std::vector<Particle>& particles,
                           const SpringLists& springs) {
  const Scene scene = testing::sceneOf(particles, springs);
  RelaxationOptions options;
  options.method = method;
  return relax(System(scene, {}), positionsOf(scene), options);
}

class Saddle : public ::testing::TestWithParam<RelaxationMethod> {
 protected:
  RelaxationResult relaxed(const std::vector<Particle>& particles, const SpringLists& springs) {
    return relaxedBy(GetParam(), particles, springs);
  }
};

INSTANTIATE_TEST_SUITE_P(Methods, Saddle,
                         ::testing::Values(RelaxationMethod::newton, RelaxationMethod::fire,
                                           RelaxationMethod::dynamics));

const Vector3 kPole(0, 0, 1);

// A turn about the pin costs no energy, which hid the way down.
TEST_P(Saddle, WithAFreeTurnAboutAPinIsLeft) {
  std::vector<Particle> particles(4, testing::particleAt(kPole));
  particles[2].pinned = true;
  SpringLists springs;
  springs.get<AngleSpring>() = {stiffSpring(1, 2, kPi, 5), stiffSpring(0, 1, 0, 86),
                                stiffSpring(1, 3, 1.4, 0.36), stiffSpring(2, 0, 0.435, 42)};
  const auto result = relaxed(particles, springs);
  EXPECT_TRUE(result.converged) << result.message;
  EXPECT_NEAR(result.energy_after, 15.5575, 1e-4);
}

// The energy of an oriented spring falls with a higher power of the way than the second.
TEST_P(Saddle, OfAnOrientedSpringWithItsEndsOnOneSpotIsLeft) {
  for (const Vector3& third : {kPole, Vector3(-kPole), Vector3(0.6, 0, 0.8), Vector3(0, -1, 0)}) {
    std::vector<Particle> particles(3, testing::particleAt(kPole));
    particles[2] = testing::particleAt(third);
    particles[2].pinned = true;
    SpringLists springs;
    springs.get<OrientedAngleSpring>() = {orientedSpring({0, 1, 2}, 1, 1)};
    const auto result = relaxed(particles, springs);
    EXPECT_TRUE(result.converged) << result.message;
    EXPECT_LT(result.energy_after, 1e-15) << third.transpose();
  }
}

TEST_P(Saddle, OfAnOrientedSpringIsAMinimumWhereOthersHoldIt) {
  SpringLists springs;
  springs.get<OrientedAngleSpring>() = {orientedSpring({0, 1, 2}, 1, 0.01)};
  springs.get<AngleSpring>() = {stiffSpring(0, 1, 0, 10), stiffSpring(1, 2, 0, 10),
                                stiffSpring(2, 0, 0, 10)};
  const auto result = relaxed(std::vector<Particle>(3, testing::particleAt(kPole)), springs);
  EXPECT_TRUE(result.converged) << result.message;
  EXPECT_NEAR(result.energy_after, 0.005, 1e-12);
}

/// Three particles at 120 degrees on the equator with arcs of rest angle 1 between them, from
/// `first`: a maximum of 1.80 J.
void addMaximum(std::uint32_t first, std::vector<Particle>& particles, SpringLists& springs) {
  for (std::uint32_t i = 0; i < 3; ++i) {
    const double turn = 2 * kPi / 3 * i;
    particles.push_back(testing::particleAt({std::cos(turn), std::sin(turn), 0}));
    springs.get<AngleSpring>().push_back(stiffSpring(first + i, first + (i + 1) % 3, 1, 1));
  }
}

void expectThreeArcsAtRest(const RelaxationResult& result, std::uint32_t first) {
  EXPECT_TRUE(result.converged) << result.message;
  EXPECT_LE(result.energy_after, result.energy_before);
  for (std::uint32_t i = 0; i < 3; ++i) {
    const auto a = result.positions.col(first + i), b = result.positions.col(first + (i + 1) % 3);
    EXPECT_NEAR(arc(a, b).angle, 1, 1e-8);
  }
}

// The rounding of what they hold would hide the way down.
TEST_P(Saddle, IsLeftBesideAStiffSpringBetweenPins) {
  std::vector<Particle> particles = {testing::particleAt({1, 0, 0}),
                                     testing::particleAt({0, 1, 0})};
  particles[0].pinned = particles[1].pinned = true;
  SpringLists springs;
  springs.get<AngleSpring>() = {stiffSpring(0, 1, 0.5, 1e16)};
  addMaximum(2, particles, springs);
  expectThreeArcsAtRest(relaxed(particles, springs), 2);
}

// No other method has a time step for both.
TEST(SaddleOfNewton, IsLeftBesideAStiffGroupUnderStrain) {
  std::vector<Particle> particles = {testing::particleAt({1, 0, 0}),
                                     testing::particleAt({0, 1, 0})};
  SpringLists springs;
  springs.get<AngleSpring>() = {stiffSpring(0, 1, 0.5, 1e20), stiffSpring(0, 1, 1, 1e20)};
  addMaximum(2, particles, springs);
  expectThreeArcsAtRest(relaxedBy(RelaxationMethod::newton, particles, springs), 2);
}

// Eigen finds the lowest eigenvalue of the same matrices, written densely.
TEST(NegativeCurvature, IsFoundWhereThereIsSome) {
  int found = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    testing::Random random(seed);
    const Scene scene = testing::membraneScene(1, seed);
    const System system(scene, {});
    const TangentEnergy energy = testing::energyAt(system, positionsOf(scene), Curvature::definite);
    const BlockPattern& pattern = energy.pattern();
    Blocks<double, 2> hessian = energy.hessian();
    Eigen::VectorXd scale(pattern.rows());
    Eigen::VectorXd diagonal(2 * scale.size());
    for (Eigen::Index i = 0; i < scale.size(); ++i) {
      scale[i] = random.between(0.1, 10);
      diagonal.segment<2>(2 * i).setConstant(scale[i]);
    }
    const double lowered = std::pow(10, random.between(-9, 0));
    for (std::size_t i = 0; i < pattern.rows(); ++i) {
      hessian[pattern.diagonal[i]] -= lowered * Eigen::Matrix2d::Identity();
    }
    const Eigen::MatrixXd matrix = testing::dense(pattern, hessian);
    const double lowest = Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(
                              matrix, Eigen::MatrixXd(diagonal.asDiagonal()))
                              .eigenvalues()[0];
    MultifrontalCholesky inverse(pattern, 1);
    const Eigen::VectorXd x = negativeCurvature(inverse, pattern, hessian, scale, 1e-6);
    EXPECT_EQ(x.size() > 0, lowest < -1e-6) << seed << ": " << lowest;
    if (x.size() == 0) continue;
    ++found;
    EXPECT_LT(x.dot(matrix * x), -1e-6 * x.dot(diagonal.cwiseProduct(x))) << seed;
  }
  EXPECT_GT(found, 10);
  EXPECT_LT(found, 30);
}

// The stiff spring exerts no torque on the free particle, as its sign is settled, and so adds
// nothing to what rounding leaves there.
TEST(TorqueLimit, CountsWhatSpringsCanDo) {
  std::vector<Particle> particles = {testing::particleAt({1, 0, 0}), testing::particleAt({0, 1, 0}),
                                     testing::particleAt({0, 0, 1}),
                                     testing::particleAt(Vector3(0.1, 0, 1))};
  particles[0].pinned = particles[1].pinned = particles[3].pinned = true;
  SpringLists springs;
  springs.get<OrientedAngleSpring>() = {orientedSpring({0, 1, 2}, 1, 1e12)};
  springs.get<AngleSpring>() = {stiffSpring(2, 3, 0.2, 1e-4)};
  const Scene scene = testing::sceneOf(particles, springs);
  const auto result = relax(System(scene, {}), positionsOf(scene), {});
  EXPECT_TRUE(result.converged) << result.message;
  EXPECT_NEAR(arc(result.positions.col(2), result.positions.col(3)).angle, 0.2, 1e-8);
}

}  // namespace
}  // namespace spherical_springs::core
