#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "spherical_springs/covariance.h"
#include "spherical_springs/relaxation.h"
#include "support/rigs.h"

namespace spherical_springs::core {
namespace {

using testing::angleSpring;

const Vector3 kX(1, 0, 0), kY(0, 1, 0), kZ(0, 0, 1);

std::vector<Particle> particlesAt(const std::vector<Vector3>& places, std::uint32_t pins) {
  std::vector<Particle> particles;
  for (const Vector3& place : places) {
    particles.push_back(testing::particleAt(place));
    particles.back().pinned = particles.size() <= pins;
  }
  return particles;
}

std::vector<Matrix3> allCovariances(const Scene& scene) {
  std::vector<std::uint32_t> all(scene.particles().size());
  std::iota(all.begin(), all.end(), 0u);
  return covariances(System(scene, {}), testing::positionsOf(scene), all);
}

std::string refusal(const Scene& scene) {
  try {
    allCovariances(scene);
  } catch (const std::invalid_argument& fault) {
    return fault.what();
  }
  return "";
}

// Two angles from right angles measure two coordinates.
TEST(Covariance, OfAParticleHeldByTwoSprings) {
  SpringLists springs;
  springs.get<AngleSpring>() = {angleSpring(0, 2, kPi / 2), angleSpring(1, 2, kPi / 2)};
  springs.get<AngleSpring>()[0].stiffness = 4;
  springs.get<AngleSpring>()[1].stiffness = 25;
  const auto found = allCovariances(testing::sceneOf(particlesAt({kX, kY, kZ}, 2), springs));
  EXPECT_TRUE(found[0].isZero(0));
  EXPECT_TRUE(found[1].isZero(0));
  Eigen::Matrix3d expected = Eigen::Vector3d(1. / 4, 1. / 25, 0).asDiagonal();
  EXPECT_LT((found[2] - expected).norm(), 1e-15);
}

// When the pair as a whole is turned back, both share the error of their angle.
TEST(Covariance, OfAPairThatTurnsFreely) {
  SpringLists springs;
  springs.get<AngleSpring>() = {angleSpring(0, 1, kPi / 2)};
  springs.get<AngleSpring>()[0].stiffness = 4;
  const auto found = allCovariances(testing::sceneOf(particlesAt({kX, kY}, 0), springs));
  EXPECT_LT((found[0] - kY * kY.transpose() / 16).norm(), 1e-15);
  EXPECT_LT((found[1] - kX * kX.transpose() / 16).norm(), 1e-15);
}

// The unit of energy of a group does not matter.
TEST(Covariance, OfSoftGroupsBesideStiffOnes) {
  SpringLists springs;
  springs.get<AngleSpring>() = {angleSpring(0, 1, kPi / 2), angleSpring(2, 3, kPi / 2)};
  springs.get<AngleSpring>()[0].stiffness = 1e10;
  springs.get<AngleSpring>()[1].stiffness = 1e-10;
  const auto found = allCovariances(testing::sceneOf(particlesAt({kX, kY, kX, kY}, 0), springs));
  EXPECT_NEAR(found[0].trace(), 1e-10 / 4, 1e-22);
  EXPECT_NEAR(found[2].trace(), 1e10 / 4, 1e-2);
}

void expectMonteCarlo(const testing::Rig& rig, std::uint32_t samples) {
  constexpr double kTolerance = 0.2;  // some four deviations
  benchmark_scenes::Random random(1);
  testing::Rig exact = rig;
  const auto count = static_cast<Eigen::Index>(rig.particles.size());
  for (Eigen::Index i = 0; i < count; ++i) exact.particles[i].position = rig.truth.col(i);
  auto& springs = exact.springs.get<AngleSpring>();
  for (AngleSpring& spring : springs) rest(spring, System::points(spring, rig.truth));
  const auto found = allCovariances(exact.scene());

  std::vector<Eigen::Matrix3d> sums(count, Eigen::Matrix3d::Zero());
  for (std::uint32_t k = 0; k < samples; ++k) {
    testing::Rig measured = exact;
    for (AngleSpring& spring : measured.springs.get<AngleSpring>()) {
      spring.rest_angle += random.normal() / std::sqrt(spring.stiffness);
    }
    const Scene scene = measured.scene();
    const auto result = relax(System(scene, {}), testing::positionsOf(scene), {});
    ASSERT_TRUE(result.converged) << result.message;
    for (Eigen::Index i = 0; i < count; ++i) {
      const Vector3 error = result.positions.col(i) - rig.truth.col(i);
      sums[i] += error * error.transpose() / samples;
    }
  }
  for (Eigen::Index i = 0; i < count; ++i) {
    EXPECT_LE((sums[i] - found[i]).norm(), kTolerance * found[i].norm()) << i;
  }
}

TEST(Covariance, IsThatOfRepeatedCalibrations) {
  testing::Rig rig = testing::rigOf(7, 1e-3, 2);
  for (std::size_t s = 0; s < rig.springs.get<AngleSpring>().size(); s += 3) {
    rig.springs.get<AngleSpring>()[s].stiffness /= 9;
  }
  expectMonteCarlo(rig, 1000);
  rig.particles[0].pinned = false;
  expectMonteCarlo(rig, 1000);
  rig.particles[0].pinned = rig.particles[3].pinned = true;
  expectMonteCarlo(rig, 1000);
}

TEST(Covariance, IsRefusedAwayFromAMinimum) {
  SpringLists springs;
  springs.get<AngleSpring>() = {angleSpring(0, 1, 1), angleSpring(1, 2, 1), angleSpring(0, 2, 1)};
  EXPECT_NE(refusal(testing::sceneOf(particlesAt({kX, kY, kZ}, 0), springs))
                .find("not at a minimum of the energy: particle 0 has a torque of "),
            std::string::npos);
  // Three on a great circle as far apart as they can be, which want to be nearer.
  for (AngleSpring& spring : springs.get<AngleSpring>()) spring.rest_angle = kPi / 2;
  const double h = std::sqrt(0.75);
  const Scene saddle =
      testing::sceneOf(particlesAt({{1, 0, 0}, {-0.5, h, 0}, {-0.5, -h, 0}}, 0), springs);
  EXPECT_NE(refusal(saddle).find("it falls in some direction"), std::string::npos)
      << refusal(saddle);
}

TEST(Covariance, IsRefusedWhereSpringsHoldNothing) {
  SpringLists chain;
  chain.get<AngleSpring>() = {angleSpring(0, 1, kPi / 2), angleSpring(1, 2, kPi / 2),
                              angleSpring(2, 3, kPi / 4)};
  const std::vector<Vector3> places = {kX, kY, kZ, {1, 0, 1}};
  EXPECT_FALSE(refusal(testing::sceneOf(particlesAt(places, 0), chain)).empty());
  SpringLists triangle;
  triangle.get<AngleSpring>() = {angleSpring(0, 1, kPi / 2)};
  EXPECT_EQ(refusal(testing::sceneOf(particlesAt({kX, kY, kZ}, 0), triangle)),
            "particle 2 has no spring that holds it");
}

}  // namespace
}  // namespace spherical_springs::core
