#include <gtest/gtest.h>

#include <cmath>

#include "spherical_springs/relaxation.h"
#include "support/relaxation_scenes.h"
#include "support/scenes.h"

namespace spherical_springs::core {
namespace {

class Relaxation : public ::testing::TestWithParam<const char*> {
 protected:
  RelaxationResult relaxed(const Scene& scene, double tolerance = 1e-11) {
    return relaxed(System(scene, {}), testing::positionsOf(scene), tolerance);
  }
  RelaxationResult relaxed(const System& system, const Points& positions, double tolerance) {
    RelaxationOptions options;
    options.method = relaxationMethod(GetParam());
    options.tolerance = tolerance;
    return relax(system, positions, options);
  }
};
INSTANTIATE_TEST_SUITE_P(Methods, Relaxation, ::testing::Values("newton", "dynamics", "fire"));

Scene sceneAt(const std::vector<Vector3>& places, const SpringLists& springs,
              const std::vector<std::size_t>& pinned = {}) {
  std::vector<Particle> particles;
  for (const Vector3& place : places) particles.push_back(testing::particleAt(place));
  for (const std::size_t i : pinned) particles[i].pinned = true;
  return testing::sceneOf(particles, springs);
}

/// Arcs between all pairs of `count` particles.
SpringLists allPairs(std::uint32_t count, double rest_angle) {
  SpringLists springs;
  for (std::uint32_t i = 0; i < count; ++i) {
    for (std::uint32_t j = i + 1; j < count; ++j) {
      springs.get<AngleSpring>().push_back(testing::angleSpring(i, j, rest_angle));
    }
  }
  return springs;
}

Scene withoutTriangles(Scene scene) {
  const auto& ids = scene.springs<SolidAngleSpring>().ids();
  SpringIds triangles;
  triangles.get<SolidAngleSpring>().assign(ids.begin(), ids.end());
  scene.removeSprings(triangles);
  return scene;
}

double angleBetween(const Points& positions, int i, int j) {
  return arc(positions.col(i), positions.col(j)).angle;
}

// Figure 3 of the report.
TEST_P(Relaxation, OpensThreeArcsIntoTheOctant) {
  const auto result =
      relaxed(sceneAt({{1, 0.15, 0.05}, {0.9, 0.5, 0.1}, {0.9, 0.1, 0.5}}, allPairs(3, kPi / 2)));
  EXPECT_TRUE(result.converged) << result.message;
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(angleBetween(result.positions, i, (i + 1) % 3), kPi / 2, 1e-10);
  }
  EXPECT_LT(result.energy_after, 1e-20);
  EXPECT_GT(result.energy_before, 0.1);
}

TEST_P(Relaxation, FindsTheTetrahedronOfFourTrianglesOfPi) {
  SpringLists springs;
  springs.get<SolidAngleSpring>() = {
      testing::solidAngleSpring(0, 1, 2, kPi), testing::solidAngleSpring(0, 2, 3, kPi),
      testing::solidAngleSpring(0, 3, 1, kPi), testing::solidAngleSpring(1, 3, 2, kPi)};
  const auto result = relaxed(
      sceneAt({{0.1, 0.2, 1}, {1, 0.1, -0.4}, {-0.4, 1, -0.3}, {-0.6, -0.9, -0.4}}, springs));
  ASSERT_TRUE(result.converged) << result.message;
  // Four equal areas leave two freedoms beside rotations; the areas are what is fixed.
  EXPECT_LT(result.energy_after, 1e-20);
}

// Springs in series between pinned ends: each takes its share of the stretch.
TEST_P(Relaxation, OfAChainBetweenPinnedEnds) {
  SpringLists springs;
  for (std::uint32_t i = 0; i < 3; ++i) {
    springs.get<AngleSpring>().push_back(testing::angleSpring(i, i + 1, 0.2));
    springs.get<AngleSpring>()[i].stiffness = i + 1;
  }
  const auto at = [](double angle, double off) {
    return Vector3(std::cos(angle), std::sin(angle), off);
  };
  const auto scene = sceneAt({at(0, 0), at(0.3, 0.1), at(1, -0.2), at(1.5, 0)}, springs, {0, 3});
  const auto result = relaxed(scene);
  ASSERT_TRUE(result.converged) << result.message;
  const double tension = (1.5 - 0.6) / (1 + 1 / 2. + 1 / 3.);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(angleBetween(result.positions, i, i + 1), 0.2 + tension / (i + 1), 1e-9);
  }
  EXPECT_EQ(result.positions.col(0), testing::positionsOf(scene).col(0));
  EXPECT_EQ(result.positions.col(3), testing::positionsOf(scene).col(3));
}

// Equally spaced on a great circle, the three pull evenly: a saddle above the octant.
TEST_P(Relaxation, LeavesASaddle) {
  const double s = std::sqrt(3) / 2;
  const auto result =
      relaxed(sceneAt({{1, 0, 0}, {-0.5, s, 0}, {-0.5, -s, 0}}, allPairs(3, kPi / 2)));
  EXPECT_TRUE(result.converged) << result.message;
  EXPECT_LT(result.energy_after, 1e-20);
}

TEST_P(Relaxation, PartsParticlesOnOneSpot) {
  const std::vector<Vector3> spot(3, Vector3(1, 2, 3));
  const auto first = relaxed(sceneAt(spot, allPairs(3, kPi / 2)));
  EXPECT_TRUE(first.converged) << first.message;
  EXPECT_LT(first.energy_after, 1e-20);
  const auto second = relaxed(sceneAt(spot, allPairs(3, kPi / 2)));
  EXPECT_EQ(first.positions, second.positions);
}

TEST_P(Relaxation, OfOrientedSpringsUndoesAnInversion) {
  const SpringLists springs = testing::threeOrientedArcs();
  const auto result = relaxed(sceneAt({{1, 0.1, 0.1}, {0.2, 0.3, 1}, {0.1, 1, 0.3}}, springs));
  ASSERT_TRUE(result.converged) << result.message;
  const Points& p = result.positions;
  EXPECT_NEAR(solidAngle(p.col(0), p.col(1), p.col(2)), kPi / 2, 1e-9);
}

TEST_P(Relaxation, SaysSoWhenRoundingCannotReachTheTolerance) {
  const auto result = relaxed(withoutTriangles(testing::randomScene(1, 20, 30)), 1e-30);
  EXPECT_FALSE(result.converged);
  EXPECT_LT(result.max_torque, 1e-12);
  EXPECT_NE(result.message.find("rounding"), std::string::npos) << result.message;
}

// In a random network some triangle is pulled across a great circle until two of its vertices are
// antipodal and it has no area any more.
TEST_P(Relaxation, SaysSoWhenATriangleHasNoArea) {
  const auto result = relaxed(testing::randomScene(1, 40, 40));
  EXPECT_FALSE(result.converged);
  EXPECT_NE(result.message.find("has antipodal vertices"), std::string::npos) << result.message;
  EXPECT_LT(result.energy_after, 0.1 * result.energy_before);
}

TEST_P(Relaxation, OfNothingIsConverged) {
  EXPECT_TRUE(relaxed(Scene(), 0).converged);
  EXPECT_TRUE(relaxed(sceneAt({{1, 0, 0}}, {}), 0).converged);
  EXPECT_TRUE(relaxed(sceneAt({{1, 0, 0}, {0, 1, 0}}, allPairs(2, 1), {0, 1}), 0).converged);
}

TEST_P(Relaxation, EndsWhenToldToAtItsBest) {
  const auto scene = testing::randomScene(2, 50, 80);
  RelaxationOptions options;
  options.method = relaxationMethod(GetParam());
  int calls = 0;
  options.go_on = [&](const RelaxationProgress& progress) {
    EXPECT_GE(progress.fraction, 0);
    EXPECT_LE(progress.fraction, 1);
    return ++calls < 4;
  };
  const auto result = relax(System(scene, {}), testing::positionsOf(scene), options);
  EXPECT_FALSE(result.converged);
  EXPECT_EQ(result.iterations, 3);
  EXPECT_LT(result.energy_after, result.energy_before);
  EXPECT_EQ(result.message.rfind("cancelled", 0), 0) << result.message;
}

TEST_P(Relaxation, KeepsTheBitsOfPinnedParticles) {
  const Scene random = testing::randomScene(4, 60, 4);
  std::vector<Particle> particles = random.particles().items();
  for (std::size_t i = 0; i < 30; ++i) particles[i].pinned = true;
  const Scene scene = testing::sceneOf(particles, testing::springsOf(random));
  const Points start = testing::positionsOf(scene);
  for (const bool keep_orientation : {false, true}) {
    RelaxationOptions options;
    options.method = relaxationMethod(GetParam());
    options.keep_orientation = keep_orientation;
    int calls = 0;
    options.go_on = [&](const RelaxationProgress&) { return ++calls < 200; };
    const auto result = relax(System(scene, {}), start, options);
    EXPECT_EQ(result.positions.leftCols(30), start.leftCols(30));
    EXPECT_NE(result.positions, start);
  }
}

TEST_P(Relaxation, EndsWhenItsTimeIsOver) {
  const auto scene = testing::randomScene(3, 50, 80);
  RelaxationOptions options;
  options.method = relaxationMethod(GetParam());
  options.max_time = 1e-9;
  const auto result = relax(System(scene, {}), testing::positionsOf(scene), options);
  EXPECT_FALSE(result.converged);
  EXPECT_EQ(result.message.rfind("max_time is over", 0), 0) << result.message;
}

TEST(RelaxationOptions, AreChecked) {
  const System system(Scene(), {});
  for (const double bad : {-1., std::nan("")}) {
    RelaxationOptions options;
    options.tolerance = bad;
    EXPECT_THROW(relax(system, Points(3, 0), options), std::invalid_argument);
    options = {};
    options.max_time = bad;
    EXPECT_THROW(relax(system, Points(3, 0), options), std::invalid_argument);
  }
  EXPECT_THROW(relaxationMethod("simplex"), std::invalid_argument);
}

TEST(RandomScenes, AreRelaxedToMinimaByNewton) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const auto scene = withoutTriangles(testing::randomScene(seed, 40, 40));
    const auto result = relax(System(scene, {}), testing::positionsOf(scene), {});
    EXPECT_TRUE(result.converged) << seed << ": " << result.message;
    EXPECT_LT(result.energy_after, result.energy_before);
  }
}

// Folded triangles curve the energy downward. Where all else is near the minimum they must not
// drive the whole mesh along; benchmark/relaxation.cpp has the iterations ("folded triangles").
TEST(AMeshOf40962, GetsPastFoldedTriangles) {
  const Scene scene = testing::membraneScene(6);
  const double edge = scene.springs<AngleSpring>().items().front().rest_angle;
  const System system(scene, {});
  for (unsigned seed = 1; seed <= 3; ++seed) {
    testing::Random random(seed);
    Points start = testing::positionsOf(scene);
    for (Eigen::Index i = 0; i < start.cols(); ++i) {
      start.col(i) = testing::displaced(start.col(i), 0.4 * edge, random);
    }
    const auto result = relax(system, start, {});
    EXPECT_TRUE(result.converged) << seed << ": " << result.message;
  }
}

}  // namespace
}  // namespace spherical_springs::core
