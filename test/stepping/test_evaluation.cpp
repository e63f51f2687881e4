// Energies and torques several springs at a time against those of one at a time.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "spherical_springs/measures.h"
#include "stepping/evaluation.h"
#include "support/relaxation_scenes.h"
#include "support/step_levels.h"
#include "support/trajectory.h"

namespace spherical_springs::core {
namespace {

using testing::solidAngleSpring;
using testing::stepKernelsHere;

std::shared_ptr<const Plan> planOf(const Scene& scene, int threads = 1) {
  return std::make_shared<const Plan>(scene, System::Options{SpringDamping::relative, threads});
}

/// Arcs and triangles at the edges of their formulas, and an oriented arc with a sharp step.
Scene hardScene() {
  const Vector3 a = Vector3(1, 2, 3).normalized();
  std::vector<Particle> particles;
  for (const Vector3& p :
       {a, a, Vector3(-a), rotated(-a, 1e-9 * perpendicular(a)), Vector3(0, 1, 0), Vector3(1, 0, 0),
        rotated(a, 1e-7 * perpendicular(a))}) {
    particles.push_back(testing::particleAt(p));
  }
  SpringLists springs;
  for (std::uint32_t i = 1; i < particles.size(); ++i) {
    springs.get<AngleSpring>().push_back(testing::angleSpring(0, i, 0.5));
    springs.get<SolidAngleSpring>().push_back(
        solidAngleSpring(0, i, 1 + i % (particles.size() - 1), i % 2 == 0 ? 6.2 : -6.2));
    OrientedAngleSpring oriented;
    oriented.particles = {0, i, 1 + i % static_cast<std::uint32_t>(particles.size() - 1)};
    oriented.stiffness = 1;
    oriented.rest_angle = i % 2 == 0 ? 0 : 1;
    oriented.width = 1e-300;
    springs.get<OrientedAngleSpring>().push_back(oriented);
  }
  return testing::sceneOf(particles, springs);
}

std::vector<Scene> scenes() {
  return {Scene(),
          testing::membraneScene(1),
          testing::pinnedScene(testing::membraneScene(5), {7, 8, 9, 4000}),
          testing::chainScene(1, 1500, 0),
          testing::randomScene(1, 40, 60),
          testing::randomScene(2, 3000, 3000),
          hardScene()};
}

TEST(Evaluation, OfEnergiesIsThatOfOneSpringAtATime) {
  for (const Scene& scene : scenes()) {
    const auto plan = planOf(scene);
    const System& system = *plan->system();
    const Points positions = testing::positionsOf(scene);
    const PotentialEnergies expected = system.potential(positions);
    for (const StepKernels* kernels : stepKernelsHere()) {
      const PotentialEnergies result = Evaluation(*plan, positions, *kernels).potential();
      forEachKind([&](auto kind) {
        using Spring = typename decltype(kind)::type;
        const double joules = expected.get<Spring>().joules;
        EXPECT_NEAR(result.get<Spring>().joules, joules, 1e-13 * joules) << Spring::kTable;
      });
    }
  }
}

TEST(Evaluation, OfTheLargestTorqueIsThatOfOneSpringAtATime) {
  for (const Scene& scene : scenes()) {
    const auto plan = planOf(scene);
    const System& system = *plan->system();
    const Points positions = testing::positionsOf(scene);
    System::Workspace workspace;
    system.evaluate(positions, workspace);
    double expected = 0;
    for (Eigen::Index i = 0; i < system.particleCount(); ++i) {
      if (!system.pinned(i)) expected = std::max(expected, workspace.torques.col(i).norm());
    }
    for (const StepKernels* kernels : stepKernelsHere()) {
      EXPECT_NEAR(Evaluation(*plan, positions, *kernels).maxTorque(), expected, 1e-12 * expected);
    }
  }
}

/// A scene with other numbers of particles and springs, which join as before.
Scene withOtherNumbers(const Scene& scene) {
  testing::Random random(9);
  auto particles = scene.particles().items();
  for (Particle& particle : particles) particle.mass *= random.between(1, 2);
  SpringLists springs = testing::springsOf(scene);
  forEachKind([&](auto kind) {
    for (auto& spring : springs.get<typename decltype(kind)::type>()) {
      spring = random.spring<std::decay_t<decltype(spring)>>(spring.particles);
    }
  });
  return testing::sceneOf(particles, springs);
}

/// Several springs of each kind on the same particles.
Scene parallelScene() {
  const Scene scene = testing::randomScene(3, 1500, 500);
  SpringLists springs = testing::springsOf(scene);
  forEachKind([&](auto kind) {
    auto& list = springs.get<typename decltype(kind)::type>();
    const auto once = list;
    for (const auto& spring : once) {
      list.push_back(spring);
      list.back().stiffness *= 1.7;
    }
  });
  return testing::sceneOf(scene.particles().items(), springs);
}

TEST(Evaluation, OfAPlanAfterAnEarlierOneIsThatOfAPlanAnew) {
  auto all = scenes();
  all.push_back(parallelScene());
  for (const Scene& scene : all) {
    const auto earlier = planOf(scene);
    const Scene changed = withOtherNumbers(scene);
    const Points positions = testing::positionsOf(scene);
    const Plan after(changed, {}, *earlier), anew(changed, {});
    const PotentialEnergies energies = Evaluation(after, positions).potential();
    const PotentialEnergies expected = Evaluation(anew, positions).potential();
    forEachKind([&](auto kind) {
      using Spring = typename decltype(kind)::type;
      EXPECT_EQ(energies.get<Spring>().joules, expected.get<Spring>().joules) << Spring::kTable;
    });
    EXPECT_EQ(Evaluation(after, positions).maxTorque(), Evaluation(anew, positions).maxTorque());
    EXPECT_EQ(after.layout().order(), earlier->layout().order());
  }
}

// Below 1e-30 a pair counts as antipodal, and the area as undefined.
TEST(Evaluation, OfTheLargestTorqueIsBoundedNearAntipodalPairs) {
  SpringLists springs;
  springs.get<SolidAngleSpring>() = {testing::solidAngleSpring(0, 1, 2, 1)};
  springs.get<SolidAngleSpring>()[0].stiffness = 1e30;
  const auto torqueAt = [&](double away) {
    const Scene scene =
        testing::sceneOf({testing::particleAt({0.6, 0, 0.8}), testing::particleAt({1, 0, 0}),
                          testing::particleAt({-1, away, 0})},
                         springs);
    return maxTorque(Plan(scene, System::Options()), testing::stateOf(scene));
  };
  EXPECT_EQ(torqueAt(1e-143), 0);
  EXPECT_GT(torqueAt(1e-28), 1e57);
  EXPECT_LT(torqueAt(1e-28), 1e62);
}

TEST(Evaluation, LeavesTorquesOnPinsOut) {
  const Scene scene = testing::membraneScene(1);
  const double all = maxTorque(*planOf(scene), testing::stateOf(scene));
  std::vector<std::uint32_t> pins(scene.particles().size() - 1);
  std::iota(pins.begin(), pins.end(), 0);
  const Scene pinned = testing::pinnedScene(scene, pins);
  EXPECT_LT(maxTorque(*planOf(pinned), testing::stateOf(pinned)), all);
  pins.push_back(static_cast<std::uint32_t>(pins.size()));
  const Scene stuck = testing::pinnedScene(scene, pins);
  EXPECT_EQ(maxTorque(*planOf(stuck), testing::stateOf(stuck)), 0);
}

TEST(Evaluation, GivesTheSameBitsOnAnyNumberOfThreads) {
  const Scene scene = testing::membraneScene(5);
  const Points positions = testing::positionsOf(scene);
  const auto one = planOf(scene);
  for (const int threads : {2, 3, 7}) {
    const auto many = planOf(scene, threads);
    EXPECT_EQ(Evaluation(*many, positions).potential().total(),
              Evaluation(*one, positions).potential().total());
    EXPECT_EQ(Evaluation(*many, positions).maxTorque(), Evaluation(*one, positions).maxTorque());
  }
}

TEST(Evaluation, IsOfThePositionsGivenNotOfThoseOfTheLayout) {
  const Scene scene = testing::membraneScene(2);
  const auto plan = planOf(scene);
  const System& system = *plan->system();
  const Points positions = testing::positionsOf(testing::membraneScene(2, 5));
  EXPECT_NEAR(Evaluation(*plan, positions).potential().total(), system.potential(positions).total(),
              1e-13 * system.potential(positions).total());
}

}  // namespace
}  // namespace spherical_springs::core
