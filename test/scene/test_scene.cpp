#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "spherical_springs/scene.h"
#include "support/scenes.h"

namespace spherical_springs::core {
namespace {

using Ids = std::vector<std::uint32_t>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Three particles on the axes.
Scene octant() {
  Scene scene;
  scene.addParticles({testing::particleAt({1, 0, 0}), testing::particleAt({0, 1, 0}),
                      testing::particleAt({0, 0, 1})});
  return scene;
}

SpringLists lists(const AngleSpring& spring) {
  SpringLists springs;
  springs.get<AngleSpring>() = {spring};
  return springs;
}

std::string refusal(const std::function<void()>& call) {
  try {
    call();
  } catch (const std::invalid_argument& fault) {
    return fault.what();
  }
  return "not refused";
}

TEST(SceneIds, RiseFromZeroAndAreNeverGivenAgain) {
  Scene scene = octant();
  EXPECT_EQ(scene.particles().ids(), (Ids{0, 1, 2}));
  scene.removeParticles({1});
  EXPECT_EQ(scene.addParticles({testing::particleAt({0, 1, 0})}), Ids{3});
  EXPECT_EQ(scene.particles().find(1), std::nullopt);
  EXPECT_EQ(scene.particles().find(3), 2);
  scene.clear();
  EXPECT_EQ(scene.addParticles({testing::particleAt({0, 1, 0})}), Ids{4});
}

TEST(SceneIds, OfAnEarlierSceneAreNotGivenAgain) {
  Scene scene;
  scene.reserveIdsOf(octant());
  EXPECT_EQ(scene.addParticles({testing::particleAt({0, 1, 0})}), Ids{3});
}

TEST(SceneIds, ThatAreUsedUpAreRefusedWithTheReason) {
  Scene scene({}, {4294967292}, {testing::particleAt({1, 0, 0})}, {}, {});
  EXPECT_EQ(refusal([&] {
              scene.addParticles(std::vector(3, testing::particleAt({0, 1, 0})));
            }),
            "particles to add are 3, and 2 ids are left: the largest is 4294967294, and none is "
            "given twice; they begin from 0 again after a new start");
  EXPECT_EQ(scene.addParticles(std::vector(2, testing::particleAt({0, 1, 0}))),
            (Ids{4294967293, 4294967294}));
  scene.clear();
  EXPECT_EQ(refusal([&] {
              scene.addParticles({testing::particleAt({0, 1, 0})});
            }).find("particles to add are 1, and 0 ids are left: "),
            0u);
}

TEST(SceneLimitsOfIndices, BoundAllOthers) {
  const SceneLimits held = SceneLimits{2'000'000'000, 2'000'000'000}.heldByIndices();
  EXPECT_EQ(held.particles, SceneLimits::kMostParticles);
  EXPECT_EQ(held.springs, SceneLimits::kMostSprings);
  const SceneLimits small = SceneLimits{7, 8}.heldByIndices();
  EXPECT_EQ(small.particles, 7);
  EXPECT_EQ(small.springs, 8);
}

TEST(SceneParticles, ComeNormalised) {
  Particle particle = testing::particleAt({0, 0, 3e200});
  particle.angular_velocity = {1, 2, 3};
  Scene scene;
  scene.addParticles({particle});
  const Particle& taken = scene.particles().item(0);
  EXPECT_EQ(taken.position, Vector3(0, 0, 1));
  EXPECT_EQ(taken.angular_velocity, Vector3(1, 2, 0));
  EXPECT_EQ(taken.mass, 1);
}

TEST(SceneParticles, HoweverFastTurnAboutNoAxisThroughThemselves) {
  for (const double speed : {1., 1e20, 1e69, 5e99}) {
    Particle particle = testing::particleAt({-1, -1, -1});
    particle.angular_velocity = speed * Vector3(1, 1, 1);
    Scene scene;
    scene.addParticles({particle});
    EXPECT_EQ(scene.particles().item(0).angular_velocity, Vector3(0, 0, 0)) << speed;
  }
}

TEST(SceneParticles, TakeTheirSpringsWithThem) {
  Scene scene = octant();
  SpringLists springs;
  springs.get<AngleSpring>() = {testing::angleSpring(0, 1, 1), testing::angleSpring(1, 2, 1)};
  springs.get<SolidAngleSpring>() = {testing::solidAngleSpring(0, 1, 2, 1)};
  scene.addSprings(springs, testing::positionsOf(scene));
  EXPECT_EQ(scene.removeParticles({0}).springs, 2);
  EXPECT_EQ(scene.springs<AngleSpring>().ids(), Ids{1});
  EXPECT_EQ(scene.springs<SolidAngleSpring>().size(), 0);
}

TEST(SceneSprings, AtRestTakeThePresentValue) {
  Scene scene = octant();
  AngleSpring spring = testing::angleSpring(0, 1, kNan);
  spring.at_rest = true;
  Points elsewhere = testing::positionsOf(scene);
  elsewhere.col(1) = Vector3(0, 0, -1);
  scene.addSprings(lists(spring), elsewhere);
  EXPECT_DOUBLE_EQ(scene.springs<AngleSpring>().item(0).rest_angle, kPi / 2);
  EXPECT_FALSE(scene.springs<AngleSpring>().item(0).at_rest);
}

struct BadParticle {
  const char* message;
  std::function<void(Particle&)> spoil;
};

TEST(SceneRefuses, BadParticlesAndKeepsNothing) {
  const std::vector<BadParticle> table = {
      {"particles[1].position is (0, 0, 0); allowed: any finite non-zero vector",
       [](Particle& p) { p.position.setZero(); }},
      {"particles[1].position is (nan, 0, 0); allowed: any finite non-zero vector",
       [](Particle& p) { p.position.x() = -kNan; }},
      {"particles[1].position is (inf, 0, 0); allowed: any finite non-zero vector",
       [](Particle& p) { p.position.x() = kInfinity; }},
      {"particles[1].angular_velocity is (0, nan, 0); allowed: finite, of length up to 1e100 "
       "[rad/s]",
       [](Particle& p) { p.angular_velocity.y() = kNan; }},
      {"particles[1].mass is -1; allowed: 0 (meaning 1), or 1e-30 to 1e30 [kg]",
       [](Particle& p) { p.mass = -1; }},
      {"particles[1].mass is 1e-31; allowed: 0 (meaning 1), or 1e-30 to 1e30 [kg]",
       [](Particle& p) { p.mass = 1e-31; }},
      {"particles[1].damping is -0.5; allowed: 0 to 1e30 [N m s/rad]",
       [](Particle& p) { p.damping = -0.5; }},
      {"particles[1].damping is inf; allowed: 0 to 1e30 [N m s/rad]",
       [](Particle& p) { p.damping = kInfinity; }},
  };
  for (const BadParticle& bad : table) {
    Scene scene = octant();
    std::vector<Particle> particles(3, testing::particleAt({1, 0, 0}));
    bad.spoil(particles[1]);
    EXPECT_EQ(refusal([&] { scene.addParticles(particles); }), bad.message);
    EXPECT_EQ(refusal([&] { scene.setParticles({0, 1, 2}, particles); }), bad.message);
    EXPECT_EQ(scene.particles().size(), 3);
    EXPECT_EQ(scene.particles().item(1).position, Vector3(0, 1, 0));
  }
}

struct BadSpring {
  const char* message;
  std::function<void(SpringLists&)> spoil;
};

TEST(SceneRefuses, BadSpringsAndKeepsNothing) {
  const std::vector<BadSpring> table = {
      {"angle_springs[0].particles[1] is 7; allowed: the id of a particle; there are 3, from 0 to "
       "2",
       [](SpringLists& s) { s.get<AngleSpring>()[0].particles[1] = 7; }},
      {"angle_springs[0].particles[1] is 0 again; allowed: particles that differ",
       [](SpringLists& s) { s.get<AngleSpring>()[0].particles[1] = 0; }},
      {"angle_springs[0].rest_angle is 3.2; allowed: 0 to pi [rad]",
       [](SpringLists& s) { s.get<AngleSpring>()[0].rest_angle = 3.2; }},
      {"angle_springs[0].rest_angle is nan; allowed: 0 to pi [rad]",
       [](SpringLists& s) { s.get<AngleSpring>()[0].rest_angle = kNan; }},
      {"angle_springs[0].stiffness is 0; allowed: above 0, from 1e-30 to 1e30 [J/rad^2]",
       [](SpringLists& s) { s.get<AngleSpring>()[0].stiffness = 0; }},
      {"angle_springs[0].damping is -1; allowed: 0 to 1e30 [N m s/rad]",
       [](SpringLists& s) { s.get<AngleSpring>()[0].damping = -1; }},
      {"solid_angle_springs[0].particles[2] is 1 again; allowed: particles that differ",
       [](SpringLists& s) { s.get<SolidAngleSpring>()[0].particles[2] = 1; }},
      {"solid_angle_springs[0].rest_solid_angle is -6.283185307179586; allowed: above -2 pi, up to "
       "2 pi [sr]",
       [](SpringLists& s) { s.get<SolidAngleSpring>()[0].rest_solid_angle = -2 * kPi; }},
      {"oriented_angle_springs[0].rest_angle is -3.2; allowed: -pi to pi [rad]",
       [](SpringLists& s) { s.get<OrientedAngleSpring>()[0].rest_angle = -3.2; }},
      {"oriented_angle_springs[0].width is 1.5; allowed: 0 (the default) to 1",
       [](SpringLists& s) { s.get<OrientedAngleSpring>()[0].width = 1.5; }},
  };
  for (const BadSpring& bad : table) {
    Scene scene = octant();
    SpringLists springs;
    springs.get<AngleSpring>() = {testing::angleSpring(0, 1, 1)};
    springs.get<SolidAngleSpring>() = {testing::solidAngleSpring(0, 1, 2, 1)};
    springs.get<OrientedAngleSpring>().resize(1);
    springs.get<OrientedAngleSpring>()[0].particles = {0, 1, 2};
    springs.get<OrientedAngleSpring>()[0].stiffness = 1;
    const Points positions = testing::positionsOf(scene);
    SpringLists spoiled = springs;
    bad.spoil(spoiled);
    EXPECT_EQ(refusal([&] { scene.addSprings(spoiled, positions); }), bad.message);
    EXPECT_EQ(scene.springCount(), 0);

    const SpringIds ids = scene.addSprings(springs, positions);
    EXPECT_EQ(refusal([&] { scene.setSprings(ids, spoiled, positions); }), bad.message);
    EXPECT_EQ(scene.springs<AngleSpring>().item(0).rest_angle, 1);
  }
}

TEST(SceneRefuses, BadIds) {
  Scene scene = octant();
  const Particle particle = testing::particleAt({1, 1, 1});
  EXPECT_EQ(refusal([&] {
              scene.removeParticles({0, 9});
            }),
            "ids[1] is 9; allowed: the id of a particle; there are 3, from 0 to 2");
  EXPECT_EQ(refusal([&] {
              scene.removeParticles({0, 0});
            }),
            "ids[1] is 0 again; allowed: each id once");
  EXPECT_EQ(refusal([&] {
              scene.setParticles({0, 1}, {particle});
            }),
            "ids has 2 items and particles has 1; allowed: as many of one as of the other");
  EXPECT_EQ(refusal([&] { scene.setParticles({0}, {}); }),
            "ids has 1 item and particles has 0; allowed: as many of one as of the other");
  EXPECT_EQ(scene.particles().size(), 3);

  SpringIds ids;
  ids.get<SolidAngleSpring>() = {0};
  EXPECT_EQ(refusal([&] { scene.removeSprings(ids); }),
            "solid_angle_spring_ids[0] is 0; allowed: the id of a spring among the solid angle "
            "springs; there is none");
}

TEST(SceneRefuses, IdsBesideTheOnlyOne) {
  Scene scene = octant();
  scene.removeParticles({0, 2});
  EXPECT_EQ(refusal([&] { scene.removeParticles({0}); }),
            "ids[0] is 0; allowed: the id of a particle; there is 1");
}

TEST(Scene, TakesPiAsItIsRounded) {
  Scene scene = octant();
  const auto restsOf = [&](double rest_angle, double rest_solid_angle) {
    SpringLists springs;
    springs.get<AngleSpring>() = {testing::angleSpring(0, 1, 1)};
    springs.get<AngleSpring>()[0].rest_angle = std::abs(rest_angle);
    springs.get<SolidAngleSpring>() = {testing::solidAngleSpring(0, 1, 2, 1)};
    springs.get<SolidAngleSpring>()[0].rest_solid_angle = rest_solid_angle;
    springs.get<OrientedAngleSpring>().resize(1);
    springs.get<OrientedAngleSpring>()[0].particles = {0, 1, 2};
    springs.get<OrientedAngleSpring>()[0].stiffness = 1;
    springs.get<OrientedAngleSpring>()[0].rest_angle = rest_angle;
    const SpringIds ids = scene.addSprings(springs, testing::positionsOf(scene));
    return std::vector<double>{scene.springs<AngleSpring>().items().back().rest_angle,
                               scene.springs<OrientedAngleSpring>().items().back().rest_angle,
                               scene.springs<SolidAngleSpring>().items().back().rest_solid_angle};
  };
  EXPECT_EQ(restsOf(3.1416, 6.2832), (std::vector<double>{kPi, kPi, 2 * kPi}));
  EXPECT_EQ(restsOf(static_cast<float>(kPi), static_cast<float>(2 * kPi)),
            (std::vector<double>{kPi, kPi, 2 * kPi}));
  EXPECT_EQ(restsOf(-3.1416, 3.1416), (std::vector<double>{kPi, -kPi, 3.1416}));
  EXPECT_EQ(restsOf(3.1415, 6.2831), (std::vector<double>{3.1415, 3.1415, 6.2831}));
  for (const double beyond : {3.1417, 3.15}) {
    EXPECT_NE(refusal([&] { restsOf(beyond, 1); }), "");
    EXPECT_NE(refusal([&] { restsOf(1, 2 * beyond); }), "");
  }
}

TEST(SceneRefuses, MoreThanItsLimits) {
  SceneLimits limits;
  limits.particles = 3;
  limits.springs = 1;
  Scene scene(limits);
  scene.addParticles(std::vector<Particle>(3, testing::particleAt({1, 0, 0})));
  EXPECT_EQ(refusal([&] {
              scene.addParticles({testing::particleAt({1, 0, 0})});
            }),
            "particles would be 4 in all; allowed: at most 3");
  SpringLists springs = lists(testing::angleSpring(0, 1, 1));
  springs.get<SolidAngleSpring>() = {testing::solidAngleSpring(0, 1, 2, 1)};
  EXPECT_EQ(refusal([&] { scene.addSprings(springs, testing::positionsOf(scene)); }),
            "springs would be 2 in all; allowed: at most 1");
  EXPECT_EQ(scene.springCount(), 0);
}

}  // namespace
}  // namespace spherical_springs::core
