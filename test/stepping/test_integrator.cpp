#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "spherical_springs/integrator.h"
#include "spherical_springs/measures.h"
#include "stepping/blocked_splitting.h"
#include "support/scenes.h"
#include "support/trajectory.h"
#include "transcription/report.h"

namespace spherical_springs::core {
namespace {

using testing::Random;
using testing::Trajectory;

double largestDistance(const Points& a, const Points& b) {
  return (a - b).colwise().norm().maxCoeff();
}

report::Scene transcribed(const Scene& scene) {
  report::Scene result;
  const auto vector = [](const Vector3& v) { return report::Vector{v.x(), v.y(), v.z()}; };
  for (const Particle& p : scene.particles().items()) {
    result.particles.push_back(
        {vector(p.position), 0.5 * vector(p.angular_velocity), p.mass, p.damping});
  }
  for (const AngleSpring& s : scene.springs<AngleSpring>().items()) {
    result.angle_springs.push_back(
        {{int(s.particles[0]), int(s.particles[1])}, s.rest_angle, s.stiffness});
  }
  for (const SolidAngleSpring& s : scene.springs<SolidAngleSpring>().items()) {
    result.solid_angle_springs.push_back(
        {{int(s.particles[0]), int(s.particles[1]), int(s.particles[2])},
         s.rest_solid_angle,
         s.stiffness});
  }
  return result;
}

double distanceFromReport(const Scene& scene, double time_step, int steps) {
  report::Scene plain = transcribed(scene);
  for (int i = 0; i < steps; ++i) report::step(plain, time_step);
  // The report knows of no steps that are divided.
  BlockedSplitting euler(std::make_shared<const Plan>(scene, System::Options()),
                         splittingScheme(IntegrationMethod::euler), time_step, Passing::ignored);
  const State state = testing::stepped(euler, scene, steps);
  double largest = 0;
  for (std::size_t i = 0; i < plain.particles.size(); ++i) {
    const report::Vector p = plain.particles[i].position;
    largest = std::max(largest, (state.positions.col(i) - Vector3(p.x, p.y, p.z)).norm());
  }
  return largest;
}

/// A random scene of the springs that the report defines, its triangles within 1 of their rest
/// areas, so that the report's plain difference of areas is the one modulo 4 pi too.
Scene reportScene(unsigned seed, double damping) {
  Random random(seed);
  std::vector<Particle> particles(12);
  for (Particle& particle : particles) {
    particle.position = random.unitVector();
    particle.mass = random.between(0.5, 2);
    particle.angular_velocity = 0.5 * random.unitVector();
    particle.damping = damping;
  }
  SpringLists springs;
  while (springs.get<SolidAngleSpring>().size() < 20) {
    const auto arc = random.distinctBelow<2>(12);
    springs.get<AngleSpring>().push_back(random.spring<AngleSpring>(arc));
    auto triangle = random.spring<SolidAngleSpring>(random.distinctBelow<3>(12));
    const auto [a, b, c] = triangle.particles;
    const double area =
        solidAngle(particles[a].position, particles[b].position, particles[c].position);
    triangle.rest_solid_angle = area + random.between(-1, 1);
    if (std::abs(area) < 2) springs.get<SolidAngleSpring>().push_back(triangle);
  }
  return testing::sceneOf(particles, springs);
}

TEST(Euler, IsTheReportToTheLetter) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    EXPECT_LT(distanceFromReport(reportScene(seed, 0), 1e-3, 200), 1e-12) << seed;
  }
}

// The report's explicit damping is the first term of the exact decay used here.
TEST(Euler, DampedDiffersFromTheReportInFirstOrder) {
  const Scene scene = reportScene(1, 1);
  const double coarse = distanceFromReport(scene, 2e-3, 100);
  const double fine = distanceFromReport(scene, 1e-3, 200);
  EXPECT_GT(coarse, 1e-6);
  EXPECT_NEAR(coarse / fine, 2, 0.2);
}

/// Two particles on one arc, pulled 0.3 beyond the rest angle.
Scene pair(double mass, double damping) {
  std::vector<Particle> particles(2);
  particles[0].position = Vector3(1, 0, 0);
  particles[1].position = Vector3(std::cos(1.3), std::sin(1.3), 0);
  for (Particle& particle : particles) particle.mass = mass;
  SpringLists springs;
  springs.get<AngleSpring>() = {testing::angleSpring(0, 1, 1)};
  springs.get<AngleSpring>()[0].damping = damping;
  return testing::sceneOf(particles, springs);
}

double angleOf(const State& state) {
  return arc(state.positions.col(0), state.positions.col(1)).angle;
}

// theta'' = -(2 k / m) (theta - rest) - (2 c / m) theta'
TEST(Pair, IsAHarmonicOscillator) {
  const double frequency = std::sqrt(2 / 3.);
  for (const double time : {1., 7., 30.}) {
    const int steps = int(std::lround(time / 1e-4));
    const Trajectory run(pair(3, 0), "verlet", 1e-4, steps);
    EXPECT_NEAR(angleOf(run.state), 1 + 0.3 * std::cos(frequency * time), 1e-7) << time;
  }
}

TEST(Pair, DampedBySpringIsADampedOscillator) {
  const double c = 0.4, decay = c, frequency = std::sqrt(2 - decay * decay), time = 3;
  const Trajectory run(pair(1, c), "verlet", 1e-4, 30000);
  const double expected =
      0.3 * std::exp(-decay * time) *
      (std::cos(frequency * time) + decay / frequency * std::sin(frequency * time));
  EXPECT_NEAR(angleOf(run.state), 1 + expected, 1e-7);
}

// For a pair, each particle's own part of dC/dt is half of the whole.
TEST(Pair, OwnSpringDampingIsHalfAsStrongOnAPair) {
  System::Options own;
  own.spring_damping = SpringDamping::own;
  const Trajectory half(pair(1, 0.2), "verlet", 1e-3, 2000);
  const Trajectory run(pair(1, 0.4), "verlet", 1e-3, 2000, own);
  EXPECT_NEAR(angleOf(run.state), angleOf(half.state), 1e-7);
}

class Scheme : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(All, Scheme,
                         ::testing::Values("euler", "verlet", "fourth_order", "implicit_euler"));

double measuredOrder(const Scene& scene, const std::string& scheme, System::Options options) {
  const int order = orderOf(integrationMethod(scheme));
  const double step = order == 4 ? 1e-2 : 1e-3;  // long enough for errors above rounding
  const int steps = int(std::lround(0.4 / step));
  const Trajectory reference(scene, "fourth_order", 1e-3, 400, options);
  const Trajectory coarse(scene, scheme, step, steps, options);
  const Trajectory fine(scene, scheme, step / 2, 2 * steps, options);
  return std::log2(largestDistance(coarse.state.positions, reference.state.positions) /
                   largestDistance(fine.state.positions, reference.state.positions));
}

TEST_P(Scheme, HasItsOrderWithAndWithoutDamping) {
  const int order = orderOf(integrationMethod(GetParam()));
  for (const double damping : {0., 0.05}) {
    for (const SpringDamping kind : {SpringDamping::relative, SpringDamping::own}) {
      System::Options options;
      options.spring_damping = kind;
      Scene scene = reportScene(2, damping);
      SpringIds ids;
      SpringLists springs;
      forEachKind([&](auto kind) {
        using Spring = typename decltype(kind)::type;
        const auto& table = scene.springs<Spring>();
        ids.get<Spring>().assign(table.ids().begin(), table.ids().end());
        for (Spring spring : table.items()) {
          spring.damping = damping;
          springs.get<Spring>().push_back(spring);
        }
      });
      scene.setSprings(ids, springs, testing::positionsOf(scene));
      EXPECT_NEAR(measuredOrder(scene, GetParam(), options), order, 0.15) << damping;
    }
  }
}

TEST_P(Scheme, ConservesTotalAndDissipatedToItsOrder) {
  const double step = std::string(GetParam()) == "fourth_order" ? 5e-3 : 1e-3;
  const int steps = int(std::lround(0.5 / step));
  for (const double damping : {0., 0.3}) {
    const Scene scene = testing::randomScene(6, 8, 10, damping, 0.5);
    const double start = Trajectory(scene, GetParam(), step, 0).conserved();
    const double coarse = std::abs(Trajectory(scene, GetParam(), step, steps).conserved() - start);
    const double fine =
        std::abs(Trajectory(scene, GetParam(), step / 4, 4 * steps).conserved() - start);
    EXPECT_LT(coarse, 0.02 * start);
    const double expected = std::pow(4, orderOf(integrationMethod(GetParam())));
    EXPECT_GT(coarse / fine, 0.4 * expected) << damping;
  }
}

TEST_P(Scheme, ConservesAngularMomentumWithRelativeSpringDamping) {
  if (std::string(GetParam()) == "implicit_euler") GTEST_SKIP() << "conserves it to first order";
  const Scene scene = testing::randomScene(5, 8, 10, 0.3, 0.5);
  const Trajectory start(scene, GetParam(), 1e-3, 0), end(scene, GetParam(), 1e-3, 2000);
  const Vector3 change = end.system().angularMomentum(end.state.angular_velocities) -
                         start.system().angularMomentum(start.state.angular_velocities);
  EXPECT_LT(change.norm(), 1e-12);
  EXPECT_GT(end.state.dissipated, 0.1);
}

TEST_P(Scheme, StaysOnTheSphere) {
  const int steps = std::string(GetParam()) == "implicit_euler" ? 500 : 20000;
  const Trajectory run(testing::randomScene(6, 8, 10, 0, 3), GetParam(), 1e-3, steps);
  EXPECT_LT(normError(run.state), 4 * 2.3e-16);
  for (Eigen::Index i = 0; i < run.state.positions.cols(); ++i) {
    EXPECT_NEAR(run.state.positions.col(i).dot(run.state.angular_velocities.col(i)), 0, 1e-14);
  }
}

TEST_P(Scheme, GivesTheSameBitsForAnyNumberOfThreads) {
  const Scene scene = testing::chainScene(7, 5000, 0.1);
  System::Options two;
  two.threads = 2;
  const Trajectory one(scene, GetParam(), 1e-3, 20), both(scene, GetParam(), 1e-3, 20, two);
  EXPECT_EQ(one.state.positions, both.state.positions);
  EXPECT_EQ(one.state.angular_velocities, both.state.angular_velocities);
  EXPECT_EQ(one.state.dissipated, both.state.dissipated);
  EXPECT_EQ(energies(*one.plan, one.state).total(), energies(*both.plan, both.state).total());
}

TEST_P(Scheme, NeverMovesPinnedParticles) {
  Scene scene = testing::randomScene(8, 6, 10, 0.1);
  Particle particle = scene.particles().item(2);
  particle.pinned = true;
  particle.angular_velocity = Vector3(1, 2, 3);
  scene.setParticles({2}, {particle});
  const Trajectory run(scene, GetParam(), 1e-3, 1000);
  EXPECT_EQ(run.state.positions.col(2), scene.particles().item(2).position);
  EXPECT_EQ(run.state.angular_velocities.col(2), Vector3::Zero());
  EXPECT_NEAR(run.conserved(), Trajectory(scene, GetParam(), 1e-3, 0).conserved(), 1);
}

TEST_P(Scheme, BearsAnyDamping) {
  Scene scene = testing::randomScene(9, 8, 10, 1e12, 0.5);
  std::vector<Particle> particles = scene.particles().items();
  particles[0].damping = 1e12;
  scene.setParticles(scene.particles().ids(), particles);
  const Trajectory start(scene, GetParam(), 1e-2, 0), end(scene, GetParam(), 1e-2, 500);
  EXPECT_LE(energies(*end.plan, end.state).total(), energies(*start.plan, start.state).total());
  EXPECT_TRUE(end.state.positions.allFinite());
}

TEST(StableTimeStep, OfAPairIsTwoOverItsFrequency) {
  const Scene scene = pair(3, 0);
  const System system(scene, {});
  const auto stable = [&](const System& s, const Points& p) {
    return stableTimeStep(s, IntegrationMethod::verlet, p);
  };
  EXPECT_NEAR(stable(system, testing::positionsOf(scene)), 2 / std::sqrt(2 / 3.), 0.1);
  EXPECT_TRUE(std::isinf(stable(System(Scene(), {}), Points(3, 0))));
}

TEST(IntegrationMethod, OtherNamesAreRefused) {
  EXPECT_THROW(integrationMethod("rk4"), std::invalid_argument);
}

}  // namespace
}  // namespace spherical_springs::core
