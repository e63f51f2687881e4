// Relaxations on the way to and from places where two vertices of a triangle are antipodal.
#include <gtest/gtest.h>

#include <string>
#include <type_traits>
#include <vector>

#include "spherical_springs/relaxation.h"
#include "support/relaxation_scenes.h"

namespace spherical_springs::core {
namespace {

using testing::positionsOf;

/// A few particles, the first of which may be pinned, and springs of all kinds with rest areas that
/// no triangle far from antipodal vertices has.
Scene mixedScene(unsigned seed) {
  testing::Random random(seed);
  const std::uint32_t count = 3 + seed % 10;
  std::vector<Particle> particles(count);
  for (Particle& particle : particles) particle = testing::particleAt(random.unitVector());
  particles[0].pinned = seed % 3 == 0;
  SpringLists springs;
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    for (unsigned i = 0; i < 1 + seed % 7; ++i) {
      auto spring = random.spring<Spring>(random.distinctBelow<Spring::kParticles>(count));
      spring.stiffness = 1;
      if constexpr (std::is_same_v<Spring, SolidAngleSpring>) {
        spring.rest_solid_angle = random.between(-6, 6);
      }
      springs.get<Spring>().push_back(spring);
    }
  });
  return testing::sceneOf(particles, springs);
}

// In these scenes the way led through such a place, and on to a minimum above the start.
TEST(UndefinedPlaces, OnTheWayLeadNoHigherThanTheStart) {
  for (const unsigned seed : {80u, 431u, 970u, 1160u}) {
    const System system(mixedScene(seed), {});
    const auto result = relax(system, positionsOf(mixedScene(seed)), {});
    EXPECT_LE(result.energy_after, result.energy_before) << seed << ": " << result.message;
  }
}

// In these scenes a torque counted for nothing beside the stiffness of a triangle whose vertices
// were nearly antipodal: the next relaxation went on.
TEST(UndefinedPlaces, AreNotConvergedTo) {
  int converged = 0;
  for (const unsigned seed : {48u, 89u, 136u, 155u, 159u, 184u, 221u, 235u}) {
    const System system(mixedScene(seed), {});
    const auto result = relax(system, positionsOf(mixedScene(seed)), {});
    if (!result.converged) {
      EXPECT_NE(result.message.find("antipodal"), std::string::npos) << result.message;
      continue;
    }
    ++converged;
    const auto again = relax(system, result.positions, {});
    EXPECT_TRUE(again.converged) << seed << ": " << again.message;
    EXPECT_LT((again.positions - result.positions).norm(), 1e-9) << seed;
  }
  EXPECT_GT(converged, 0);
}

}  // namespace
}  // namespace spherical_springs::core
