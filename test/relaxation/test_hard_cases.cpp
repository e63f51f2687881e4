// Scenes that break simulators: what must come out of stepping and of relaxation.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "spherical_springs/relaxation.h"
#include "support/scenes.h"
#include "support/trajectory.h"

namespace spherical_springs::core {
namespace {

using testing::angleSpring;
using testing::arcs;
using testing::expectSound;
using testing::threeArcs;
using testing::threeOrientedArcs;
using testing::Trajectory;

struct HardCase {
  std::string name;
  Scene scene;
  double energy_at_rest;  ///< that relaxation must reach [J]
};

Scene sceneOf(const std::vector<Vector3>& places, const SpringLists& springs) {
  std::vector<Particle> particles;
  for (const Vector3& place : places) particles.push_back(testing::particleAt(place));
  return testing::sceneOf(particles, springs);
}

SpringLists triangle(double rest_solid_angle) {
  SpringLists springs;
  springs.get<SolidAngleSpring>() = {testing::solidAngleSpring(0, 1, 2, rest_solid_angle)};
  return springs;
}

void addPairs(std::vector<HardCase>& cases) {
  const Vector3 a = Vector3(1, 2, 3).normalized();
  const Vector3 beside = rotated(a, 1e-12 * perpendicular(a));
  for (const double rest : {0., 1., kPi}) {
    const std::string text = " pair, rest angle " + std::to_string(rest);
    cases.push_back({"coinciding" + text, sceneOf({a, a}, arcs({angleSpring(0, 1, rest)})), 0});
    cases.push_back({"antipodal" + text, sceneOf({a, -a}, arcs({angleSpring(0, 1, rest)})), 0});
    cases.push_back({"close" + text, sceneOf({a, beside}, arcs({angleSpring(0, 1, rest)})), 0});
    cases.push_back(
        {"nearly antipodal" + text, sceneOf({a, -beside}, arcs({angleSpring(0, 1, rest)})), 0});
  }
}

void addTriples(std::vector<HardCase>& cases) {
  const Vector3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  const double s = std::sqrt(3) / 2;
  const std::vector<Vector3> circle = {x, {-0.5, s, 0}, {-0.5, -s, 0}};
  const std::vector<Vector3> point = {x, x, x}, antipodal = {x, -x, y}, octant = {x, y, z};
  cases.push_back({"arcs on a great circle", sceneOf(circle, threeArcs()), 0});
  cases.push_back({"arcs on one point", sceneOf(point, threeArcs()), 0});
  cases.push_back({"arcs with an antipodal pair", sceneOf(antipodal, threeArcs()), 0});
  cases.push_back({"a triangle on a great circle", sceneOf(circle, triangle(1)), 0});
  cases.push_back({"a triangle on one point", sceneOf(point, triangle(1)), 0});
  cases.push_back({"a hemisphere", sceneOf(octant, triangle(2 * kPi)), 0});
  cases.push_back({"an octant that wants to be the rest", sceneOf(octant, triangle(-2)), 0});
  cases.push_back({"the inverted octant, plain", sceneOf({x, z, y}, threeArcs()), 0});
  cases.push_back({"the inverted octant, oriented", sceneOf({x, z, y}, threeOrientedArcs()), 0});
}

void addRatios(std::vector<HardCase>& cases) {
  std::vector<Particle> particles;
  for (int i = 0; i < 4; ++i) {
    particles.push_back(testing::particleAt({std::cos(0.5 * i), std::sin(0.5 * i), 0.1 * i * i}));
    particles.back().mass = i % 2 == 0 ? 1e6 : 1e-6;
  }
  SpringLists springs =
      arcs({angleSpring(0, 1, 0.3), angleSpring(1, 2, 0.8), angleSpring(2, 3, 0.6)});
  springs.get<AngleSpring>()[0].stiffness = 1e6;
  springs.get<AngleSpring>()[1].stiffness = 1e-6;
  cases.push_back({"ratios of 1e12", testing::sceneOf(particles, springs), 0});
}

void addCrowds(std::vector<HardCase>& cases) {
  SpringLists chain;
  for (std::uint32_t i = 0; i + 1 < 100; ++i) {
    chain.get<AngleSpring>().push_back(angleSpring(i, i + 1, 0.05));
  }
  cases.push_back(
      {"a chain on one spot", sceneOf(std::vector<Vector3>(100, Vector3(1, 1, 1)), chain), 0});
  cases.push_back({"one particle", sceneOf({{1, 0, 0}}, {}), 0});
  cases.push_back({"nothing", Scene(), 0});
  std::vector<Particle> pins(3);
  for (int i = 0; i < 3; ++i) pins[i].position = Vector3::Unit(i);
  for (Particle& pin : pins) pin.pinned = true;
  cases.push_back({"all pinned", testing::sceneOf(pins, arcs({angleSpring(0, 1, 1)})),
                   0.5 * std::pow(kPi / 2 - 1, 2)});
}

std::vector<HardCase> hardCases() {
  std::vector<HardCase> cases;
  addPairs(cases);
  addTriples(cases);
  addRatios(cases);
  addCrowds(cases);
  return cases;
}

class HardCases : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Methods, HardCases,
                         ::testing::Values("euler", "verlet", "fourth_order", "implicit_euler"));

TEST_P(HardCases, StaySoundAndMakeNoEnergy) {
  const IntegrationMethod method = integrationMethod(GetParam());
  for (const HardCase& hard : hardCases()) {
    SCOPED_TRACE(hard.name);
    const Trajectory start(hard.scene, GetParam(), 1, 0);
    const double stable =
        stableTimeStep(start.system(), IntegrationMethod::verlet, start.state.positions);
    const double step = std::min(0.02 * stable, 0.01);
    const int steps = method == IntegrationMethod::implicit_euler ? 200 : 1000;
    const Trajectory once(hard.scene, GetParam(), step, steps);
    expectSound(once.state);
    const double before = start.conserved();
    const double made = once.conserved() - before;
    EXPECT_LT(made, (orderOf(method) == 1 ? 5e-2 : 1e-3) * before + 1e-20);
    const Trajectory twice(hard.scene, GetParam(), step, steps);
    EXPECT_EQ(once.state.positions, twice.state.positions);
  }
}

TEST_P(HardCases, StayFiniteBeyondTheStableStep) {
  for (const HardCase& hard : hardCases()) {
    SCOPED_TRACE(hard.name);
    const Trajectory start(hard.scene, GetParam(), 1, 0);
    const double stable =
        stableTimeStep(start.system(), IntegrationMethod::verlet, start.state.positions);
    for (const double factor : {1.5, 1e3}) {
      expectSound(Trajectory(hard.scene, GetParam(), std::min(factor * stable, 1e6), 50).state);
    }
  }
}

class HardRelaxations : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Methods, HardRelaxations, ::testing::Values("newton", "fire"));

TEST_P(HardRelaxations, EndAtTheMinimumTheSameWayEveryRun) {
  for (const HardCase& hard : hardCases()) {
    SCOPED_TRACE(hard.name);
    RelaxationOptions options;
    options.method = relaxationMethod(GetParam());
    const System system(hard.scene, {});
    // Beside a stiff spring fire leaves one that is 1e12 times as soft where rounding has it.
    if (options.method == RelaxationMethod::fire && hard.name == "ratios of 1e12") {
      options.tolerance = 1e-9 * system.largestStiffness();
    }
    const Points start = testing::positionsOf(hard.scene);
    const auto once = relax(system, start, options);
    EXPECT_TRUE(once.converged) << once.message;
    const double scale = std::max(system.largestStiffness(), 1.);
    EXPECT_NEAR(once.energy_after, hard.energy_at_rest, 1e-13 * scale);
    EXPECT_EQ(once.positions, relax(system, start, options).positions);
  }
}

// Section 6 of the report: while a triangle flips, plain arcs can give its vertices extremely large
// speeds; oriented ones must not.
TEST(InvertedOctant, NoParticleIsFasterThanTheEnergyAllows) {
  const double mass = 1;
  for (const SpringLists& springs : {threeArcs(), threeOrientedArcs()}) {
    const Scene scene = sceneOf({{1, 0.1, 0.02}, {0.05, 0.1, 1}, {0.1, 1, -0.05}}, springs);
    const auto plan = std::make_shared<const Plan>(scene, System::Options());
    const auto integrator = makeIntegrator(plan, IntegrationMethod::verlet, 1e-3);
    State state = testing::stateOf(scene);
    const double allowed = std::sqrt(2 * energies(*plan, state).total() / mass);
    for (int i = 0; i < 20000; ++i) {
      integrator->step(state);
      ASSERT_LT(state.angular_velocities.colwise().norm().maxCoeff(), 1.001 * allowed) << i;
    }
  }
}

TEST(ImplicitEuler, TakesEnergyOutAtAThousandTimesTheStableStep) {
  SpringLists springs = threeArcs();
  springs.get<AngleSpring>()[0].stiffness = 1e9;
  springs.get<AngleSpring>()[2].stiffness = 1e-3;
  const Scene scene = sceneOf({{1, 0.15, 0.05}, {0.9, 0.5, 0.1}, {0.9, 0.1, 0.5}}, springs);
  const Trajectory start(scene, "implicit_euler", 1, 0);
  const double step =
      1e3 * stableTimeStep(start.system(), IntegrationMethod::verlet, start.state.positions);
  const Trajectory end(scene, "implicit_euler", step, 100);
  expectSound(end.state);
  EXPECT_EQ(end.state.unconverged_steps, 0);
  EXPECT_LT(end.conserved(), 1e-6 * start.conserved());
}

TEST(ImplicitEuler, MakesNoEnergyWhereTheSpringsAreNotConvex) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Scene scene = testing::randomScene(seed, 8, 10, 0, 3);
    const auto plan = std::make_shared<const Plan>(scene, System::Options());
    State state = testing::stateOf(scene);
    const double stable =
        stableTimeStep(*plan->system(), IntegrationMethod::verlet, state.positions);
    for (const double factor : {0.3, 3., 30.}) {
      const auto integrator =
          makeIntegrator(plan, IntegrationMethod::implicit_euler, factor * stable);
      for (int i = 0; i < 30; ++i) {
        const double before = energies(*plan, state).total();
        integrator->step(state);
        ASSERT_LE(energies(*plan, state).total(), before * (1 + 1e-12)) << seed << " " << factor;
      }
    }
  }
}

// Where an unconverged minimum leaves no energy for the velocities, and there are none.
// A scene that is read drops what velocities have along the positions.
TEST(ImplicitEuler, LeavesVelocitiesThatReadingKeepsToTheLastBit) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const Scene soft = testing::randomScene(seed, 10, 8, 1);
    SpringLists springs = testing::springsOf(soft);
    forEachKind([&](auto kind) {
      for (auto& spring : springs.get<typename decltype(kind)::type>()) spring.stiffness *= 1e10;
    });
    const auto& items = soft.particles().items();
    const Scene scene = testing::sceneOf({items.begin(), items.end()}, springs);
    for (const int steps : {1, 2}) {
      const State state = Trajectory(scene, "implicit_euler", 1, steps).state;
      for (Eigen::Index i = 0; i < state.positions.cols(); ++i) {
        const Vector3 velocity = state.angular_velocities.col(i);
        EXPECT_EQ(tangentPart(state.positions.col(i), velocity), velocity) << seed << " " << i;
      }
    }
  }
}

TEST(ImplicitEuler, OfImpossibleSpringsStaysSound) {
  SpringLists springs = arcs({angleSpring(0, 1, 1), angleSpring(0, 1, kPi)});
  springs.get<AngleSpring>()[0].damping = 1e30;
  springs.get<AngleSpring>()[1].stiffness = 1e30;
  springs.get<SolidAngleSpring>() = {testing::solidAngleSpring(0, 1, 3, -1)};
  springs.get<SolidAngleSpring>()[0].damping = 1e30;
  OrientedAngleSpring oriented;
  oriented.stiffness = 1;
  oriented.particles = {0, 1, 2};
  oriented.rest_angle = -1;
  springs.get<OrientedAngleSpring>().push_back(oriented);
  oriented.particles = {0, 2, 3};
  oriented.rest_angle = 0;
  springs.get<OrientedAngleSpring>().push_back(oriented);
  oriented.particles = {0, 1, 3};
  oriented.rest_angle = 3.1;
  oriented.width = 1e-300;
  springs.get<OrientedAngleSpring>().push_back(oriented);
  const Scene scene = sceneOf({{1, 0, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}}, springs);
  expectSound(Trajectory(scene, "implicit_euler", 1e-3, 200).state);
}

TEST(Measures, WarnBeforeAnyoneHasToWonder) {
  const Scene scene = testing::randomScene(1, 8, 10);
  const Trajectory start(scene, "verlet", 1, 0);
  Account account(*start.plan, start.state);
  const auto warning = [&](double time_step, const State& state) {
    return measure(start.plan, IntegrationMethod::verlet, time_step, state, account).warning;
  };
  EXPECT_EQ(warning(1e-4, start.state), "");
  EXPECT_NE(warning(10, start.state).find("above the stable one"), std::string::npos);
  const Trajectory blown_up(scene, "verlet", 10, 100);
  EXPECT_NE(warning(10, blown_up.state).find("the energy is off"), std::string::npos);
}

TEST(Measures, TellHowFarTheEnergyIsOffInPlainNumbers) {
  const Scene scene = testing::randomScene(1, 8, 10);
  const Trajectory start(scene, "verlet", 1e-4, 0);
  Account account(*start.plan, start.state);
  const double total = energies(*start.plan, start.state).total();
  for (const auto& [share, text] :
       {std::pair(0.123, "12"), std::pair(1., "100"), std::pair(0.996, "100"),
        std::pair(123.4, "12000"), std::pair(9.94e3, "990000"), std::pair(2e4, "2e+06")}) {
    State state = start.state;
    state.dissipated = share * total;
    EXPECT_EQ(measure(start.plan, IntegrationMethod::verlet, 1e-4, state, account)
                  .warning.rfind(std::string("the energy is off by ") + text + " % since", 0),
              0)
        << text;
  }
}

}  // namespace
}  // namespace spherical_springs::core
