// Measures of how well a simulation keeps what it should keep.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "spherical_springs/measures.h"
#include "support/trajectory.h"

namespace spherical_springs::core {
namespace {

using testing::stateOf;

/// A pair with 0.5 J of potential energy, for which steps of up to 1.4 s are stable.
struct Pair {
  Scene scene = testing::sceneOf({testing::particleAt(Vector3(1, 0, 0)),
                                  testing::particleAt(Vector3(std::cos(2.), std::sin(2.), 0))},
                                 testing::arcs({testing::angleSpring(0, 1, 1)}));
  std::shared_ptr<const Plan> plan = std::make_shared<const Plan>(scene, System::Options());
  State state = stateOf(scene);
  Account account{*plan, state};

  Measures measures(double time_step) {
    return measure(plan, IntegrationMethod::verlet, time_step, state, account);
  }
  /// Adds a kinetic energy of `omega`^2 / 2 [J].
  void push(double omega) { state.angular_velocities.col(0) = Vector3(0, 0, omega); }
};

TEST(Measures, OfAPairAtRestAreZero) {
  Pair pair;
  const Measures measures = pair.measures(0.01);
  EXPECT_EQ(measures.energy_error, 0);
  EXPECT_EQ(measures.divided_steps, 0);
  EXPECT_EQ(measures.shortest_substep, 0);
  EXPECT_FALSE(measures.blown_up);
  EXPECT_EQ(measures.warning, "");
}

TEST(Measures, CompareTheEnergyWithWhatItWas) {
  Pair pair;
  pair.push(std::sqrt(1000.));
  EXPECT_NEAR(pair.measures(0.01).energy_error, 1000, 1e-9);
  EXPECT_TRUE(pair.measures(0.01).blown_up);
}

TEST(Measures, HaveTheErrorOfAStep) {
  Pair pair;
  const Measures measures = pair.measures(0.01);
  EXPECT_GT(measures.local_error, 0);
  EXPECT_DOUBLE_EQ(measures.local_error, measures.error_rate * 0.01);
}

/// A pair that swings by 0.3 rad at sqrt(2) rad/s, at a share of its period.
State swinging(double share) {
  const double phase = 2 * kPi * share, half = (1 + 0.3 * std::cos(phase)) / 2;
  State state;
  state.positions.resize(3, 2);
  state.positions << Vector3(std::cos(half), -std::sin(half), 0),
      Vector3(std::cos(half), std::sin(half), 0);
  state.angular_velocities.resize(3, 2);
  const Vector3 velocity(0, 0, 0.15 * std::sqrt(2.) * std::sin(phase));
  state.angular_velocities << velocity, -velocity;
  return state;
}

/// The largest distance of a pair that begins at an end of its swing from where it should be, by
/// the time [rad/s].
double errorRateOfASwing(const Pair& pair, IntegrationMethod method, double time_step) {
  const auto integrator = makeIntegrator(pair.plan, method, time_step);
  State state = swinging(0);
  double largest = 0;
  while (state.time < 20) {
    integrator->step(state);
    const State exact = swinging(state.time / (std::sqrt(2.) * kPi));
    largest = std::max(largest, (state.positions - exact.positions).colwise().norm().maxCoeff());
  }
  return largest / state.time;
}

// At the end of a swing too, where an error of the phase is none of the position.
TEST(Measures, HaveTheErrorRateWhereverASwingIs) {
  const Pair pair;
  for (const IntegrationMethod method :
       {IntegrationMethod::euler, IntegrationMethod::verlet, IntegrationMethod::fourth_order}) {
    for (const double time_step : {0.3, 0.05, 0.005}) {
      const double expected = errorRateOfASwing(pair, method, time_step);
      for (const double share : {0., 0.1, 0.25, 0.4, 0.5}) {
        const double estimate = errorRate(pair.plan, method, time_step, swinging(share));
        EXPECT_GT(estimate, expected / 4) << nameOf(method) << " " << time_step << " " << share;
        EXPECT_LT(estimate, expected * 4) << nameOf(method) << " " << time_step << " " << share;
      }
    }
  }
}

TEST(Measures, HaveNoErrorWhereNothingMoves) {
  Pair pair;
  pair.state.positions.col(1) = Vector3(std::cos(1.), std::sin(1.), 0);
  EXPECT_LT(errorRate(pair.plan, IntegrationMethod::verlet, 0.1, pair.state), 1e-15);
  const auto empty = std::make_shared<const Plan>(Scene(), System::Options());
  EXPECT_EQ(errorRate(empty, IntegrationMethod::verlet, 0.1, testing::stateOf(Scene())), 0);
}

TEST(Measures, HaveTheShareOfDividedStepsOfTheAccount) {
  Pair pair;
  pair.state.steps = 40;
  const Account account(*pair.plan, pair.state);
  pair.state.steps = 80;
  pair.state.divided_steps = 10;
  EXPECT_EQ(account.dividedSteps(pair.state), 0.25);
}

TEST(Warning, NamesTheSpringThatPassed) {
  Pair pair;
  pair.push(1);
  pair.state.shortest = {1e-7, 3.14e-5, "antipodal vertices", "solid-angle spring", 7, 12.5};
  pair.state.divided_steps = pair.state.steps = 1;
  const std::string warning = pair.measures(0.01).warning;
  EXPECT_NE(warning.find("off by 100 % since the account began"), std::string::npos) << warning;
  EXPECT_NE(warning.find("though the time step of 0.01 s is below the stable one here"),
            std::string::npos)
      << warning;
  EXPECT_NE(
      warning.find("solid-angle spring 7 passed 3.1e-05 from antipodal vertices at t = 12.5 s"),
      std::string::npos)
      << warning;
  EXPECT_NE(warning.find("a shorter step, or fourth_order"), std::string::npos) << warning;
}

TEST(Warning, BlamesTheStepWhereItIsTooLong) {
  Pair pair;
  pair.push(1);
  const std::string warning = pair.measures(4).warning;
  EXPECT_NE(warning.find("the time step of 4 s is too long for this scene"), std::string::npos)
      << warning;
  EXPECT_EQ(warning.find("though"), std::string::npos) << warning;
}

}  // namespace
}  // namespace spherical_springs::core
