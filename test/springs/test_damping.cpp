#include <gtest/gtest.h>

#include "spherical_springs/damping.h"
#include "spherical_springs/system.h"
#include "support/scenes.h"
#include "support/trajectory.h"

namespace spherical_springs::core {
namespace {

struct Damped {
  System system;
  System::Workspace workspace;
  State state;

  Damped(double damping, SpringDamping kind)
      : system(scene(damping), {kind, 1}), state(testing::stateOf(scene(damping))) {
    system.evaluate(state.positions, workspace);
  }
  static Scene scene(double damping) {
    Scene result = testing::randomScene(1, 8, 10, damping, 1);
    std::vector<Particle> particles = result.particles().items();
    for (Particle& particle : particles) particle.damping = damping;
    result.setParticles(result.particles().ids(), particles);
    return result;
  }
  double kick(const Points& torques, double duration) {
    return system.damping().kick(state.positions, workspace.end_gradients, torques, duration,
                                 state.angular_velocities);
  }
};

class Dampings : public ::testing::TestWithParam<SpringDamping> {};
INSTANTIATE_TEST_SUITE_P(Kinds, Dampings,
                         ::testing::Values(SpringDamping::relative, SpringDamping::own));

// Slow enough for the series, and too fast for it.
TEST_P(Dampings, TakeOutExactlyWhatTheySay) {
  for (const double damping : {1e-3, 1., 1e3, 1e12}) {
    Damped damped(damping, GetParam());
    const double before = damped.system.kinetic(damped.state.angular_velocities);
    const double taken = damped.kick(Points::Zero(3, 8), 0.01);
    const double after = damped.system.kinetic(damped.state.angular_velocities);
    EXPECT_GT(taken, 0);
    EXPECT_NEAR(before - after, taken, 1e-13 * before) << damping;
  }
}

TEST_P(Dampings, BySeriesAreAFlow) {
  Damped once(0.1, GetParam()), twice(0.1, GetParam());
  const Points torques = once.workspace.torques;
  const double taken = once.kick(torques, 0.01);
  const double taken_in_parts = twice.kick(torques, 0.004) + twice.kick(torques, 0.006);
  EXPECT_NEAR(taken, taken_in_parts, 1e-13);
  EXPECT_LT((once.state.angular_velocities - twice.state.angular_velocities).norm(), 1e-13);

  once.kick(torques, -0.01);
  const Damped start(0.1, GetParam());
  EXPECT_LT((once.state.angular_velocities - start.state.angular_velocities).norm(), 1e-13);
}

// The two ways of computing the flow agree to second order where both hold.
// A light particle keeps only rounding of its velocity under fast dampers, in any direction.
TEST_P(Dampings, FastOnesLeaveNothingAlongThePosition) {
  for (unsigned seed = 1; seed <= 100; ++seed) {
    testing::Random random(seed);
    std::vector<Particle> particles(2);
    for (Particle& particle : particles) particle.position = random.unitVector();
    particles[0].mass = kSmallest;
    particles[1].pinned = true;
    AngleSpring spring = testing::angleSpring(0, 1, 3);
    spring.damping = 1;
    const Scene scene = testing::sceneOf(particles, testing::arcs({spring}));
    const System system(scene, {GetParam(), 1});
    State state = testing::stateOf(scene);
    System::Workspace workspace;
    system.evaluate(state.positions, workspace);
    system.damping().kick(state.positions, workspace.end_gradients, workspace.torques, 1,
                          state.angular_velocities);
    const Vector3 left = state.angular_velocities.col(0);
    EXPECT_LE(std::abs(left.dot(state.positions.col(0))), 1e-15 * left.norm());
  }
}

TEST_P(Dampings, FastOnesDoNotActBackInTime) {
  Damped damped(1e12, GetParam());
  const Points torques = damped.workspace.torques, before = damped.state.angular_velocities;
  EXPECT_EQ(damped.kick(torques, -0.01), 0);
  const Points expected = before - 0.01 * torques * damped.system.inverseMasses().asDiagonal();
  EXPECT_LT((damped.state.angular_velocities - expected).norm(), 1e-14 * expected.norm());
}

TEST_P(Dampings, FastOnesAreTheLimitOfSlowOnes) {
  double differences[2];
  for (const int fine : {0, 1}) {
    const double duration = fine ? 0.5 : 1;
    Damped whole(1, GetParam()), parts(1, GetParam());
    const Points torques = whole.workspace.torques;
    for (int i = 0; i < (fine ? 64 : 32); ++i) whole.kick(torques, duration / 32);
    for (int i = 0; i < (fine ? 8192 : 4096); ++i) parts.kick(torques, duration / 4096);
    differences[fine] = (whole.state.angular_velocities - parts.state.angular_velocities).norm();
  }
  EXPECT_GT(differences[0], 1e-9);
  EXPECT_LT(differences[1], differences[0]);
}

}  // namespace
}  // namespace spherical_springs::core
