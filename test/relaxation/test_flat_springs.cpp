// Oriented springs whose first two ends are on one spot or nearly so.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "spherical_springs/relaxation.h"
#include "support/relaxation_scenes.h"

namespace spherical_springs::core {
namespace {

using testing::angleSpring;
using testing::positionsOf;

OrientedAngleSpring orientedSpring(double rest_angle) {
  OrientedAngleSpring spring;
  spring.particles = {0, 1, 2};
  spring.rest_angle = rest_angle;
  spring.stiffness = 1;
  return spring;
}

SpringLists oriented(double rest_angle) {
  SpringLists springs;
  springs.get<OrientedAngleSpring>() = {orientedSpring(rest_angle)};
  return springs;
}

class FlatSprings : public ::testing::TestWithParam<RelaxationMethod> {
 protected:
  /// Relaxes particles, the first `pins` of them pinned.
  RelaxationResult relaxed(const std::vector<Vector3>& places, std::size_t pins,
                           const SpringLists& springs) {
    std::vector<Particle> particles;
    for (const Vector3& place : places) {
      particles.push_back(testing::particleAt(place));
      particles.back().pinned = particles.size() <= pins;
    }
    const Scene scene = testing::sceneOf(particles, springs);
    start_ = positionsOf(scene);
    RelaxationOptions options;
    options.method = GetParam();
    return relax(System(scene, {}), start_, options);
  }

  void expectKept(const RelaxationResult& result) const {
    EXPECT_TRUE(result.converged) << result.message;
    EXPECT_EQ(result.positions, start_);
    EXPECT_EQ(result.energy_before, result.energy_after);
  }

  Points start_;
};

INSTANTIATE_TEST_SUITE_P(Methods, FlatSprings,
                         ::testing::Values(RelaxationMethod::newton, RelaxationMethod::fire,
                                           RelaxationMethod::dynamics));

const Vector3 kX(1, 0, 0), kPole(0, 0, 1);
constexpr double kShort = 5e-4;  // [rad]

// The third particle sets the sign of a signed angle of 0.
TEST_P(FlatSprings, MoveNothingWhereNothingChangesTheirEnergy) {
  expectKept(relaxed({kPole, kPole, kX}, 2, oriented(1)));
}

TEST_P(FlatSprings, MoveNothingWhereTheyAreAtRest) {
  const Vector3 beside(kShort, 0, 1);
  expectKept(relaxed({kPole, beside, -Vector3::UnitY()}, 2, oriented(std::atan(kShort))));
  expectKept(relaxed({kPole, beside, Vector3::UnitY()}, 2, oriented(std::atan(kShort))));
  expectKept(relaxed({kX, {1, kShort, 0}, kPole}, 0, oriented(std::atan(kShort))));
}

TEST_P(FlatSprings, MoveNothingThatAnArcJoins) {
  SpringLists springs = oriented(1);
  springs.get<AngleSpring>() = {angleSpring(2, 3, kPi / 2)};
  expectKept(relaxed({kPole, kPole, kX, {0, 1, 0}}, 2, springs));
}

// At a distance d the energy is about 500 d^2 + (1 - 32 d^2)^2 / 2.
TEST_P(FlatSprings, AreAtAMinimumWhereAStifferArcHoldsThem) {
  SpringLists springs;
  springs.get<OrientedAngleSpring>() = {orientedSpring(1)};
  springs.get<OrientedAngleSpring>()[0].particles = {1, 0, 2};
  springs.get<AngleSpring>() = {angleSpring(0, 1, 0)};
  springs.get<AngleSpring>()[0].stiffness = 1e3;
  expectKept(relaxed({kX, kX, kPole}, 1, springs));
}

}  // namespace
}  // namespace spherical_springs::core
