// Relaxing without a fold.
#include <gtest/gtest.h>

#include <string>

#include "meshes.h"
#include "spherical_springs/relaxation.h"
#include "support/scenes.h"

namespace spherical_springs::core {
namespace {

/// A pinned edge, and a particle on its left that a strong arc pulls to a pin on its right.
Scene pulledAcross() {
  std::vector<Particle> particles = {
      testing::particleAt({1, -0.3, 0}), testing::particleAt({1, 0.3, 0}),
      testing::particleAt({1, 0.02, 0.3}), testing::particleAt({1, 0, -0.3})};
  for (const int pin : {0, 1, 3}) particles[pin].pinned = true;
  SpringLists springs = testing::arcs({testing::angleSpring(2, 3, 0)});
  springs.get<SolidAngleSpring>() = {testing::solidAngleSpring(0, 1, 2, 0.08)};
  springs.get<SolidAngleSpring>()[0].stiffness = 1e-3;
  return testing::sceneOf(particles, springs);
}

int foldedTriangles(const System& system, const Points& positions) {
  int folded = 0;
  for (const SolidAngleSpring& spring : system.springs<SolidAngleSpring>()) {
    const auto corners = System::points(spring, positions);
    folded += tripleProduct(corners[0], corners[1], corners[2]) < 0;
  }
  return folded;
}

class Orientation : public ::testing::TestWithParam<const char*> {
 protected:
  RelaxationResult relaxed(const Scene& scene, bool keep_orientation) {
    const System system(scene, {});
    RelaxationOptions options;
    options.method = relaxationMethod(GetParam());
    options.keep_orientation = keep_orientation;
    options.go_on = [&](const RelaxationProgress& progress) {
      most_folded_ = std::max(most_folded_, foldedTriangles(system, progress.best.positions));
      return true;
    };
    RelaxationResult result = relax(system, testing::positionsOf(scene), options);
    most_folded_ = std::max(most_folded_, foldedTriangles(system, result.positions));
    return result;
  }

  int most_folded_ = 0;
};
INSTANTIATE_TEST_SUITE_P(Methods, Orientation, ::testing::Values("newton", "dynamics", "fire"));

TEST_P(Orientation, GivesWayUnlessItIsToBeKept) {
  const auto free = relaxed(pulledAcross(), false);
  EXPECT_TRUE(free.converged) << free.message;
  EXPECT_EQ(most_folded_, 1);
}

TEST_P(Orientation, IsKeptAndTheMessageNamesTheTriangle) {
  const auto kept = relaxed(pulledAcross(), true);
  EXPECT_EQ(most_folded_, 0);
  EXPECT_FALSE(kept.converged);
  EXPECT_NE(kept.message.find("solid-angle spring 0 would fold"), std::string::npos)
      << kept.message;
  EXPECT_LT(kept.energy_after, 0.5 * kept.energy_before);
}

TEST_P(Orientation, OfWhatIsFoldedMayBecomeRight) {
  SpringLists springs;
  springs.get<SolidAngleSpring>() = {testing::solidAngleSpring(0, 1, 2, 1)};
  const auto result =
      relaxed(testing::sceneOf({testing::particleAt({1, 0, 0}), testing::particleAt({0.1, 0.2, 1}),
                                testing::particleAt({0.2, 1, 0.1})},
                               springs),
              true);
  EXPECT_TRUE(result.converged) << result.message;
  const Points& p = result.positions;
  EXPECT_NEAR(solidAngle(p.col(0), p.col(1), p.col(2)), 1, 1e-6);
}

// Weak arcs that would turn the mesh inside out, were it not for its triangles.
TEST_P(Orientation, OfAMeshIsKeptWhileTheRestRelaxes) {
  const auto sphere = benchmark_scenes::icosphere(2);
  testing::Random random(3);
  std::vector<Particle> particles;
  for (const Vector3& vertex : sphere.vertices) particles.push_back(testing::particleAt(vertex));
  SpringLists springs;
  for (const auto& [a, b] : sphere.edges) {
    springs.get<AngleSpring>().push_back(
        testing::angleSpring(a, b, random.between(0, 1) < 0.1 ? 1 : 0.2));
  }
  for (const auto& [a, b, c] : sphere.faces) {
    springs.get<SolidAngleSpring>().push_back(testing::solidAngleSpring(a, b, c, 4 * kPi / 320));
  }
  const Scene scene = testing::sceneOf(particles, springs);
  relaxed(scene, false);
  ASSERT_GT(most_folded_, 0) << "the test has lost its point";
  most_folded_ = 0;
  const auto kept = relaxed(scene, true);
  EXPECT_EQ(most_folded_, 0);
  EXPECT_LT(kept.energy_after, 0.9 * kept.energy_before);
}

}  // namespace
}  // namespace spherical_springs::core
