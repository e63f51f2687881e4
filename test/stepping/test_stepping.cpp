// Stepping several springs at a time against stepping them one by one, and what the result must not
// depend on.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "reference/splitting_integrator.h"
#include "stepping/blocked_splitting.h"
#include "support/relaxation_scenes.h"
#include "support/step_levels.h"
#include "support/trajectory.h"
#include "support/tumbling_scenes.h"

namespace spherical_springs::core {
namespace {

using testing::stateOf;
using testing::stepKernelsHere;
using testing::stepped;

constexpr IntegrationMethod kMethods[] = {IntegrationMethod::euler, IntegrationMethod::verlet,
                                          IntegrationMethod::fourth_order};

Scene withViscousDamping(const Scene& scene, double damping) {
  auto particles = scene.particles().items();
  for (std::size_t i = 0; i < particles.size(); ++i) {
    if (i % 3 != 0) particles[i].damping = damping * particles[i].mass;
  }
  return testing::sceneOf(particles, testing::springsOf(scene));
}

std::vector<Scene> scenes() {
  std::vector<Scene> result = {testing::membraneScene(1), testing::membraneScene(2),
                               testing::membraneScene(5), testing::chainScene(1, 1500, 0),
                               testing::randomScene(1, 40, 60, 0, 1)};
  // Crowded, so that most springs join particles of different patches.
  result.push_back(testing::randomScene(2, 3000, 3000, 0, 1));
  for (Scene& scene : result) {
    auto particles = scene.particles().items();
    testing::Random random(8);
    for (Particle& particle : particles) {
      particle.mass = random.between(0.5, 2);
      particle.angular_velocity = particle.position.cross(random.unitVector());
    }
    particles[7].pinned = true;
    particles[7].angular_velocity.setZero();
    scene = testing::sceneOf(particles, testing::springsOf(scene));
  }
  return result;
}

/// Two in three springs of every kind.
Scene withDampedSprings(const Scene& scene, double damping) {
  SpringLists springs = testing::springsOf(scene);
  testing::Random random(9);
  forEachKind([&](auto kind) {
    for (auto& spring : springs.get<typename decltype(kind)::type>()) {
      if (random.below(3) != 0) spring.damping = damping * random.between(0.5, 1);
    }
  });
  return testing::sceneOf(scene.particles().items(), springs);
}

/// Slow enough for the series, and too fast for it.
std::vector<Scene> dampedScenes() {
  std::vector<Scene> result;
  for (const Scene& scene : scenes()) {
    result.push_back(withViscousDamping(scene, 0.1));
    for (const double damping : {0.01, 1e4}) {
      result.push_back(withDampedSprings(result.back(), damping));
    }
  }
  return result;
}

std::shared_ptr<const Plan> planOf(const Scene& scene, int threads = 1,
                                   SpringDamping spring_damping = SpringDamping::relative) {
  System::Options options;
  options.threads = threads;
  options.spring_damping = spring_damping;
  return std::make_shared<const Plan>(scene, options);
}

double difference(const State& a, const State& b) {
  return std::max((a.positions - b.positions).cwiseAbs().maxCoeff(),
                  (a.angular_velocities - b.angular_velocities).cwiseAbs().maxCoeff());
}

void expectSameBits(const State& a, const State& b) {
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.angular_velocities, b.angular_velocities);
  EXPECT_EQ(a.dissipated, b.dissipated);
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.steps, b.steps);
}

TEST(Stepping, IsThatOfOneSpringAtATime) {
  for (const double damping : {0., 0.5}) {
    for (const Scene& undamped : scenes()) {
      const Scene scene = withViscousDamping(undamped, damping);
      const auto plan = planOf(scene);
      for (const IntegrationMethod method : kMethods) {
        testing::SplittingIntegrator plain(plan->system(), splittingScheme(method), 1e-3);
        const State expected = stepped(plain, scene, 3);
        for (const StepKernels* kernels : stepKernelsHere()) {
          BlockedSplitting blocked(plan, splittingScheme(method), 1e-3, Passing::ignored, *kernels);
          const State result = stepped(blocked, scene, 3);
          EXPECT_LT(difference(result, expected), 1e-13);
          EXPECT_NEAR(result.dissipated, expected.dissipated, 1e-13 * expected.dissipated);
          EXPECT_EQ(result.time, expected.time);
          EXPECT_EQ(result.steps, expected.steps);
        }
      }
    }
  }
}

class DampedStepping : public ::testing::TestWithParam<SpringDamping> {
 protected:
  State stepped(const Scene& scene, IntegrationMethod method, double step, int steps) const {
    const auto integrator = makeIntegrator(planOf(scene, 1, GetParam()), method, step);
    return testing::stepped(*integrator, scene, steps);
  }
};
INSTANTIATE_TEST_SUITE_P(Kinds, DampedStepping,
                         ::testing::Values(SpringDamping::relative, SpringDamping::own));

TEST_P(DampedStepping, IsThatOfOneSpringAtATime) {
  for (const double viscous : {0., 0.1}) {
    for (const Scene& undamped : scenes()) {
      const Scene scene = withDampedSprings(withViscousDamping(undamped, viscous), 0.01);
      const auto plan = planOf(scene, 1, GetParam());
      for (const IntegrationMethod method : kMethods) {
        testing::SplittingIntegrator plain(plan->system(), splittingScheme(method), 1e-3);
        const State expected = testing::stepped(plain, scene, 3);
        for (const StepKernels* kernels : stepKernelsHere()) {
          BlockedSplitting blocked(plan, splittingScheme(method), 1e-3, Passing::ignored, *kernels);
          const State result = testing::stepped(blocked, scene, 3);
          EXPECT_LT(difference(result, expected), 1e-13);
          EXPECT_NEAR(result.dissipated, expected.dissipated,
                      1e-14 * plan->system()->kinetic(expected.angular_velocities));
        }
      }
    }
  }
}

// In another order than one spring at a time.
TEST_P(DampedStepping, BySweepsHasTheSameLimit) {
  Scene scene = withViscousDamping(testing::randomScene(4, 1500, 1500, 0, 1), 5);
  scene = withDampedSprings(scene, 5);
  testing::SplittingIntegrator plain(planOf(scene, 1, GetParam())->system(),
                                     splittingScheme(IntegrationMethod::verlet), 1. / 2048);
  const State exact = testing::stepped(plain, scene, 128);
  const auto error = [&](int steps) {
    const State state = stepped(scene, IntegrationMethod::verlet, 1. / 16 / steps, steps);
    return (state.positions - exact.positions).norm();
  };
  EXPECT_LT(error(64), error(4) / 20);
}

TEST_P(DampedStepping, TakesOutExactlyWhatItSays) {
  for (const double damping : {1e-3, 1., 1e3, 1e12}) {
    Scene scene = withDampedSprings(testing::randomScene(2, 1500, 1500, 0, 1), damping);
    scene = withViscousDamping(scene, damping);
    SpringLists springs = testing::springsOf(scene);
    forEachKind([&](auto kind) {
      for (auto& spring : springs.get<typename decltype(kind)::type>()) spring.stiffness = 1e-30;
    });
    scene = testing::sceneOf(scene.particles().items(), springs);
    const auto plan = planOf(scene, 1, GetParam());
    const State end = stepped(scene, IntegrationMethod::euler, 0.01, 1);
    const double before = plan->system()->kinetic(stateOf(scene).angular_velocities);
    const double after = plan->system()->kinetic(end.angular_velocities);
    EXPECT_GT(end.dissipated, 0);
    EXPECT_NEAR(before - after, end.dissipated, 1e-13 * before) << damping;
  }
}

TEST_P(DampedStepping, DoesNotDampHardSpringsOtherwise) {
  SpringLists springs =
      testing::arcs({testing::angleSpring(0, 1, 1), testing::angleSpring(2, 3, 1)});
  springs.get<SolidAngleSpring>() = {testing::solidAngleSpring(2, 3, 4, 1)};
  forEachKind([&](auto kind) {
    for (auto& spring : springs.get<typename decltype(kind)::type>()) spring.damping = 0.5;
  });
  const Vector3 a = Vector3(1, 2, 3).normalized();
  std::vector<Particle> particles;
  for (const Vector3& p : {a, a, a, Vector3(-a), Vector3(0, 1, 0)}) {
    particles.push_back(testing::particleAt(p));
    particles.back().angular_velocity = p.cross(Vector3(0.1, 0.2, -0.3));
  }
  const Scene scene = testing::sceneOf(particles, springs);
  const auto plan = planOf(scene, 1, GetParam());
  testing::SplittingIntegrator plain(plan->system(), splittingScheme(IntegrationMethod::euler),
                                     1e-3);
  EXPECT_LT(difference(stepped(scene, IntegrationMethod::euler, 1e-3, 1),
                       testing::stepped(plain, scene, 1)),
            1e-15);
}

TEST(Stepping, GivesTheSameBitsOnAnyNumberOfThreads) {
  for (const Scene& scene : dampedScenes()) {
    for (const IntegrationMethod method : kMethods) {
      const State one = stepped(*makeIntegrator(planOf(scene, 1), method, 1e-3), scene, 5);
      for (const int threads : {2, 3, 7}) {
        expectSameBits(one,
                       stepped(*makeIntegrator(planOf(scene, threads), method, 1e-3), scene, 5));
      }
    }
  }
}

TEST(Stepping, GivesTheSameBitsInAnyPortions) {
  const Scene undamped = withViscousDamping(testing::membraneScene(3), 0.1);
  for (const Scene& scene : {undamped, withDampedSprings(undamped, 0.1)}) {
    for (const IntegrationMethod method : kMethods) {
      const State whole = stepped(*makeIntegrator(planOf(scene), method, 1e-3), scene, 10);
      const auto integrator = makeIntegrator(planOf(scene), method, 1e-3);
      State state = stateOf(scene);
      integrator->take(state);
      for (const int steps : {1, 0, 3, 1, 2, 3}) {
        integrator->advance(steps);
        integrator->give(state);
      }
      expectSameBits(whole, state);
      integrator->take(state);
      integrator->give(state);
      expectSameBits(whole, state);
    }
  }
}

/// A scene with its items sent in another order, triangles and arcs from another corner.
struct Shuffled {
  std::vector<std::uint32_t> places;  // of each particle of the original
  Scene scene;

  explicit Shuffled(const Scene& original) {
    testing::Random random(3);
    places.resize(original.particles().size());
    std::iota(places.begin(), places.end(), 0);
    shuffle(places, random);
    std::vector<Particle> particles(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
      particles[places[i]] = original.particles().item(i);
    }
    SpringLists springs = testing::springsOf(original);
    forEachKind([&](auto kind) {
      auto& list = springs.get<typename decltype(kind)::type>();
      shuffle(list, random);
      for (auto& spring : list) {
        for (std::uint32_t& particle : spring.particles) particle = places[particle];
      }
    });
    for (AngleSpring& spring : springs.get<AngleSpring>()) {
      if (random.below(2) == 0) std::swap(spring.particles[0], spring.particles[1]);
    }
    for (SolidAngleSpring& spring : springs.get<SolidAngleSpring>()) {
      std::rotate(spring.particles.begin(), spring.particles.begin() + random.below(3),
                  spring.particles.end());
    }
    scene = testing::sceneOf(particles, springs);
  }

  /// `result`: of the shuffled scene. `expected`: of the original.
  void expectSameBits(const State& result, const State& expected) const {
    for (std::size_t i = 0; i < places.size(); ++i) {
      ASSERT_EQ(result.positions.col(places[i]), expected.positions.col(i));
      ASSERT_EQ(result.angular_velocities.col(places[i]), expected.angular_velocities.col(i));
    }
    EXPECT_EQ(result.dissipated, expected.dissipated);
  }

  template <class List>
  static void shuffle(List& list, testing::Random& random) {
    for (std::size_t i = list.size(); i > 1; --i) {
      std::swap(list[i - 1], list[random.below(static_cast<std::uint32_t>(i))]);
    }
  }
};

TEST(Stepping, GivesTheSameBitsInWhateverOrderTheSceneIsSent) {
  for (const Scene& scene : dampedScenes()) {
    const Shuffled shuffled(scene);
    for (const IntegrationMethod method : kMethods) {
      const State expected = stepped(*makeIntegrator(planOf(scene), method, 1e-3), scene, 5);
      const State result =
          stepped(*makeIntegrator(planOf(shuffled.scene), method, 1e-3), shuffled.scene, 5);
      shuffled.expectSameBits(result, expected);
    }
  }
}

TEST(Stepping, PastPlacesWithoutDerivativeGivesTheSameBitsInWhateverOrderTheSceneIsSent) {
  testing::Tumbling has;
  has.particles = 300;
  has.arcs = has.triangles = has.oriented = 300;
  const Scene scene = testing::tumblingScene(6, has);
  const Shuffled shuffled(scene);
  for (const IntegrationMethod method : kMethods) {
    const State expected = stepped(*makeIntegrator(planOf(scene), method, 0.01), scene, 20);
    EXPECT_GT(expected.divided_steps, 10);
    const State result =
        stepped(*makeIntegrator(planOf(shuffled.scene), method, 0.01), shuffled.scene, 20);
    shuffled.expectSameBits(result, expected);
  }
}

TEST(Stepping, OfLargeAnglesIsThatOfOneSpringAtATime) {
  const Scene scene = testing::randomScene(4, 20, 20, 0, 500);  // half a turn in some milliseconds
  for (const StepKernels* kernels : stepKernelsHere()) {
    for (const double step : {1e-3, 1e-2, 1.}) {
      testing::SplittingIntegrator plain(planOf(scene)->system(),
                                         splittingScheme(IntegrationMethod::euler), step);
      BlockedSplitting blocked(planOf(scene), splittingScheme(IntegrationMethod::euler), step,
                               Passing::ignored, *kernels);
      EXPECT_LT(difference(stepped(plain, scene, 1), stepped(blocked, scene, 1)), 1e-12);
    }
  }
}

TEST(Layout, HoldsNothingForKindsThatAreNotThere) {
  const Scene whole = testing::membraneScene(3);
  const auto bytes = [&](bool arcs, bool triangles) {
    SpringLists springs;
    if (arcs) springs.get<AngleSpring>() = testing::springsOf(whole).get<AngleSpring>();
    if (triangles) {
      springs.get<SolidAngleSpring>() = testing::springsOf(whole).get<SolidAngleSpring>();
    }
    const Scene scene = testing::sceneOf(whole.particles().items(), springs);
    return planOf(scene)->layout().bytes();
  };
  const std::size_t arc = 3 * sizeof(std::uint32_t) + 2 * sizeof(double);
  const std::size_t triangle = 4 * sizeof(std::uint32_t) + 2 * sizeof(double);
  EXPECT_EQ(bytes(true, false) - bytes(false, false), 1920 * arc);
  EXPECT_EQ(bytes(false, true) - bytes(false, false), 1280 * triangle);
  EXPECT_LT(bytes(true, true), bytes(false, false) + 1920 * arc + 1280 * triangle);
}

TEST(Layout, HasOnePatchForASmallScene) {
  EXPECT_EQ(planOf(testing::membraneScene(3))->layout().patches().size(), 1);
  EXPECT_GT(planOf(testing::membraneScene(5))->layout().patches().size(), 3);
}

}  // namespace
}  // namespace spherical_springs::core
