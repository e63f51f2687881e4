// Which places a relaxation takes for an equilibrium, and what it leaves as it was.
#include <gtest/gtest.h>

#include <cmath>

#include "spherical_springs/relaxation.h"
#include "spherical_springs/simulation.h"
#include "support/relaxation_scenes.h"

namespace spherical_springs::core {
namespace {

using testing::angleSpring;
using testing::particleAt;
using testing::positionsOf;
using testing::solidAngleSpring;

class Equilibrium : public ::testing::TestWithParam<const char*> {
 protected:
  static RelaxationOptions options(double tolerance = 0) {
    RelaxationOptions options;
    options.method = relaxationMethod(GetParam());
    options.tolerance = tolerance;
    return options;
  }

  static RelaxationResult relaxed(const Scene& scene) {
    return relax(System(scene, {}), positionsOf(scene), options());
  }
};
INSTANTIATE_TEST_SUITE_P(Methods, Equilibrium, ::testing::Values("newton", "dynamics", "fire"));

Scene sceneAt(const std::vector<Vector3>& places, const SpringLists& springs,
              const std::vector<std::uint32_t>& pinned = {}) {
  std::vector<Particle> particles;
  for (const Vector3& place : places) particles.push_back(particleAt(place));
  return testing::pinnedScene(testing::sceneOf(particles, springs), pinned);
}

/// A mesh, particles without springs among those of the mesh, and a pair at rest.
Scene meshAndOthers() {
  const Scene mesh = testing::membraneScene(1);
  auto particles = mesh.particles().items();
  testing::Random random(4);
  for (int i = 0; i < 40; ++i) particles.push_back(particleAt(random.unitVector()));
  SpringLists springs = testing::springsOf(mesh);
  AngleSpring at_rest = angleSpring(50, 51, 0);
  at_rest.at_rest = true;
  springs.get<AngleSpring>().push_back(at_rest);
  return testing::sceneOf(particles, springs);
}

TEST_P(Equilibrium, KeepsTheBitsOfWhatNothingPulls) {
  constexpr Eigen::Index kMesh = 42;
  const Scene scene = meshAndOthers();
  const Points before = positionsOf(scene);
  const RelaxationResult result = relaxed(scene);
  ASSERT_TRUE(result.converged) << result.message;
  EXPECT_GT(result.iterations, 0);
  EXPECT_EQ(result.positions.rightCols(before.cols() - kMesh),
            before.rightCols(before.cols() - kMesh));
  EXPECT_NE(result.positions.leftCols(kMesh), before.leftCols(kMesh));
}

TEST_P(Equilibrium, RelaxedAgainChangesNothing) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    Scene scene = testing::membraneScene(1, seed);
    if (seed % 2 == 0) scene = testing::pinnedScene(scene, {3});
    if (seed % 3 == 0) scene = testing::pinnedScene(scene, {7, 11});
    Simulation simulation({});
    simulation.load({scene, 0});
    Relaxer relaxer;
    const auto relaxOnce = [&] {
      const auto result =
          relaxer.relax(*simulation.plan()->system(), simulation.state().positions, options());
      simulation.settle(result.positions);
      return result;
    };
    ASSERT_TRUE(relaxOnce().converged);
    const Points once = simulation.state().positions;
    const auto account = simulation.account();
    const auto again = relaxOnce();
    EXPECT_TRUE(again.converged) << again.message;
    EXPECT_EQ(again.iterations, 0u);
    EXPECT_EQ(simulation.state().positions, once) << seed;
    EXPECT_EQ(simulation.account(), account);
    // Nor by one that knows nothing of the first.
    const auto anew = relax(*simulation.plan()->system(), once, options());
    EXPECT_TRUE(anew.converged) << anew.message;
    EXPECT_EQ(anew.positions, once) << seed;
  }
}

/// Scenes without a particle that could move.
std::vector<Scene> scenesAtRest() {
  const Particle one = testing::particleAt({1, 0, 0}), other = testing::particleAt({0, 1, 0});
  const Scene pair = testing::sceneOf({one, other}, testing::arcs({testing::angleSpring(0, 1, 1)}));
  return {Scene(), testing::sceneOf({one, other}, {}), testing::pinnedScene(pair, {0, 1})};
}

TEST_P(Equilibrium, RelaxedAgainIsConvergedWhereNothingCanMove) {
  for (const Scene& scene : scenesAtRest()) {
    const System system(scene, {});
    const Points start = testing::positionsOf(scene);
    Relaxer relaxer;
    for (int times = 0; times < 3; ++times) {
      const auto result = relaxer.relax(system, start, options());
      EXPECT_TRUE(result.converged) << result.message;
      EXPECT_EQ(result.iterations, 0u);
      EXPECT_EQ(result.positions, start);
    }
  }
}

Vector3 onEquator(double angle) { return {std::cos(angle), std::sin(angle), 0}; }

/// A stiff spring stretched by `stretch` [rad], and a soft one of stiffness 1 that is 0.3 rad too
/// long: beside it, on particles of its own, or hanging from it.
Scene softBesideStiff(double stiffness, double stretch, bool hanging) {
  SpringLists springs;
  springs.get<AngleSpring>() = {angleSpring(0, 1, 1), angleSpring(hanging ? 1 : 2, 3, 0.2)};
  springs.get<AngleSpring>()[0].stiffness = stiffness;
  const Vector3 soft_end =
      hanging ? onEquator(1 + stretch + 0.5) : Vector3(std::sin(0.5), 0, std::cos(0.5));
  return sceneAt({onEquator(0), onEquator(1 + stretch), {0, 0, 1}, soft_end}, springs, {2});
}

TEST_P(Equilibrium, OfASoftSpringBesideAStiffOne) {
  // Damped stepping follows the stiff spring: the steps that the soft one asks for are without end.
  const bool newton = GetParam() == std::string("newton");
  for (const double stiffness : {1., 1e4, 1e10, 1e12}) {
    if (stiffness > 1e4 && !newton) continue;
    for (const double stretch : {0., 0.1}) {
      for (const bool hanging : {false, true}) {
        const auto result = relaxed(softBesideStiff(stiffness, stretch, hanging));
        EXPECT_TRUE(result.converged) << stiffness << ": " << result.message;
        const double soft =
            arc(result.positions.col(hanging ? 1 : 2), result.positions.col(3)).angle;
        EXPECT_NEAR(soft, 0.2, 2e-9) << stiffness << ' ' << stretch << ' ' << hanging;
        const double stiff = arc(result.positions.col(0), result.positions.col(1)).angle;
        EXPECT_NEAR(stiff, 1, 2e-9) << stiffness << ' ' << stretch << ' ' << hanging;
      }
    }
  }
}

TEST_P(Equilibrium, NamesTheParticleThatIsLeftWithTooMuch) {
  RelaxationOptions short_time = options();
  short_time.max_time = 1e-9;
  Scene scene = softBesideStiff(1e10, 0, false);
  scene.removeParticles({0, 1});
  const auto result = relax(System(scene, {}), positionsOf(scene), short_time);
  EXPECT_FALSE(result.converged);
  EXPECT_NE(result.message.find("particle 3 is left with"), std::string::npos) << result.message;
}

// Where two vertices are antipodal the area is undefined and nothing pulls.
TEST_P(Equilibrium, IsNoPlaceWhereTheAreaIsUndefined) {
  SpringLists springs;
  springs.get<SolidAngleSpring>() = {solidAngleSpring(0, 1, 2, 1)};
  for (const double beside : {0., 1e-12, 1e-9, 1e-7, 1e-3}) {
    const auto result = relaxed(sceneAt({{1, 0, 0}, {-1, 0, beside}, {0, 1, 0}}, springs));
    EXPECT_TRUE(result.converged) << beside << ": " << result.message;
    EXPECT_LT(result.energy_after, 1e-12) << beside;
  }
}

TEST_P(Equilibrium, IsNoPlaceWhereTheAreaOfOneTriangleOfManyIsUndefined) {
  const Scene mesh = testing::membraneScene(1);
  auto particles = mesh.particles().items();
  const auto first = static_cast<std::uint32_t>(particles.size());
  for (const Vector3& place : {Vector3(0, 0, 1), Vector3(0, 0, -1), Vector3(0.6, 0.8, 0)}) {
    particles.push_back(particleAt(place));
  }
  SpringLists springs = testing::springsOf(mesh);
  springs.get<SolidAngleSpring>().push_back(solidAngleSpring(first, first + 1, first + 2, -2));
  const Scene scene = testing::sceneOf(particles, springs);
  const auto result = relaxed(scene);
  EXPECT_TRUE(result.converged) << result.message;
  const Points& p = result.positions;
  EXPECT_NEAR(solidAngle(p.col(first), p.col(first + 1), p.col(first + 2)), -2, 1e-6);
}

TEST_P(Equilibrium, SaysSoWhereAnUndefinedAreaCannotBeLeft) {
  SpringLists springs;
  springs.get<SolidAngleSpring>() = {solidAngleSpring(0, 1, 2, 1), solidAngleSpring(0, 1, 3, 1)};
  Scene scene = sceneAt({{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, springs, {0, 1});
  SpringIds first;
  first.get<SolidAngleSpring>() = {0};
  scene.removeSprings(first);
  const auto result = relaxed(scene);
  EXPECT_FALSE(result.converged);
  EXPECT_NE(result.message.find("solid-angle spring 1 has antipodal vertices"), std::string::npos)
      << result.message;
}

}  // namespace
}  // namespace spherical_springs::core
