// The answer of a relaxation about the freedom that its springs leave.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "spherical_springs/relaxation.h"
#include "support/scenes.h"

namespace spherical_springs::core {
namespace {

const Vector3 kX(1, 0, 0), kY(0, 1, 0), kZ(0, 0, 1);

/// A scene at rest: arcs between all pairs, unless `joined` says otherwise, pins as told.
struct AtRest {
  std::vector<Vector3> places;
  std::vector<std::size_t> pins;
  SpringLists springs;

  explicit AtRest(std::vector<Vector3> places, std::vector<std::size_t> pins = {})
      : places(std::move(places)), pins(std::move(pins)) {}

  AtRest& join(std::uint32_t i, std::uint32_t j) {
    const double angle = arc(places[i].normalized(), places[j].normalized()).angle;
    springs.get<AngleSpring>().push_back(testing::angleSpring(i, j, angle));
    return *this;
  }
  AtRest& joinAll() {
    for (std::uint32_t j = 0; j < places.size(); ++j) {
      for (std::uint32_t i = 0; i < j; ++i) join(i, j);
    }
    return *this;
  }
  RelaxationResult relaxed() const {
    std::vector<Particle> particles;
    for (const Vector3& place : places) particles.push_back(testing::particleAt(place));
    for (const std::size_t i : pins) particles[i].pinned = true;
    const Scene scene = testing::sceneOf(particles, springs);
    return relax(System(scene, {}), testing::positionsOf(scene), {});
  }
  std::uint32_t rotations() const { return relaxed().free_rotations; }
  bool ambiguous() const { return relaxed().mirror_ambiguous; }
};

const std::vector<Vector3> kCorner = {kX, kY, kZ};

TEST(FreeRotations, AreThoseThatPinsLeave) {
  EXPECT_EQ(AtRest(kCorner).joinAll().rotations(), 3);
  EXPECT_EQ(AtRest(kCorner, {0}).joinAll().rotations(), 1);
  EXPECT_EQ(AtRest({kX, kY, kZ, -kX}, {0, 3}).joinAll().rotations(), 1);
  EXPECT_EQ(AtRest(kCorner, {0, 1}).joinAll().rotations(), 0);
  EXPECT_EQ(AtRest(kCorner, {0, 1, 2}).joinAll().rotations(), 0);
}

TEST(FreeRotations, CountThoseThatMoveSomething) {
  EXPECT_EQ(AtRest({kX, kY}).join(0, 1).rotations(), 3);
  EXPECT_EQ(AtRest({kX, kX}).join(0, 1).rotations(), 2);
  EXPECT_EQ(AtRest({kX, -kX}).join(0, 1).rotations(), 2);
  EXPECT_EQ(AtRest({kX, kX}, {0}).join(0, 1).rotations(), 0);
  EXPECT_EQ(AtRest({kX, kY}, {0}).join(0, 1).rotations(), 1);
}

TEST(FreeRotations, AreASumOverGroups) {
  const std::vector<Vector3> places = {kX, kY, kZ, {1, 1, 0}, {0, 1, 1}};
  EXPECT_EQ(AtRest({}).rotations(), 0);
  EXPECT_EQ(AtRest({kX}).rotations(), 0);
  EXPECT_EQ(AtRest(places).join(0, 1).join(2, 3).rotations(), 6);
  // The pinned one hands nothing on.
  EXPECT_EQ(AtRest(places, {2}).join(0, 2).join(0, 1).join(2, 3).join(3, 4).rotations(), 2);
}

TEST(MirrorImages, AreTold) {
  const std::vector<Vector3> places = {kX, kY, kZ, {1, 1, 1}};
  EXPECT_TRUE(AtRest(places).joinAll().ambiguous());
  EXPECT_TRUE(AtRest(places, {0}).joinAll().ambiguous());
  EXPECT_TRUE(AtRest(places, {0, 1}).joinAll().ambiguous());
  EXPECT_FALSE(AtRest(places, {0, 1, 2}).joinAll().ambiguous());
  // Pins on one great circle do not tell its sides apart.
  EXPECT_TRUE(AtRest({kX, kY, {1, 1, 0}, kZ}, {0, 1, 2}).joinAll().ambiguous());
  // Nor do those that no spring joins to the group.
  AtRest apart({kX, kY, kZ, {1, 1, 1}, {1, 2, 3}, {3, 1, 1}}, {0, 1, 2});
  EXPECT_TRUE(apart.join(3, 4).join(4, 5).join(3, 5).ambiguous());
}

TEST(MirrorImages, OfAFlatGroupAreTheGroupItself) {
  EXPECT_FALSE(AtRest({kX, kY}).join(0, 1).ambiguous());
  EXPECT_FALSE(AtRest({kX, kY, {1, 1, 0}, {-1, 2, 0}}).joinAll().ambiguous());
  EXPECT_TRUE(AtRest(kCorner).joinAll().ambiguous());
}

TEST(MirrorImages, AreToldByASpringWithASign) {
  AtRest oriented = AtRest(kCorner).joinAll();
  OrientedAngleSpring spring;
  spring.particles = {0, 1, 2};
  spring.stiffness = 1e-3;
  spring.rest_angle = kPi / 2;
  oriented.springs.get<OrientedAngleSpring>().push_back(spring);
  EXPECT_FALSE(oriented.ambiguous());
  AtRest area = AtRest(kCorner).joinAll();
  area.springs.get<SolidAngleSpring>().push_back(testing::solidAngleSpring(0, 1, 2, kPi / 2));
  EXPECT_FALSE(area.ambiguous());
  // One at rest at half of the sphere is as far from both.
  area.springs.get<SolidAngleSpring>().back().rest_solid_angle = 2 * kPi;
  area.springs.get<SolidAngleSpring>().back().stiffness = 1e-6;
  EXPECT_TRUE(area.ambiguous());
}

TEST(MirrorImages, OfOneGroupAreEnough) {
  AtRest two({kX, kY, kZ, {1, 1, 0}, {0, 1, 1}, {1, 0, 1}});
  two.join(0, 1).join(1, 2).join(0, 2).join(3, 4).join(4, 5).join(3, 5);
  two.springs.get<SolidAngleSpring>().push_back(testing::solidAngleSpring(0, 1, 2, kPi / 2));
  EXPECT_TRUE(two.ambiguous());
}

TEST(RmsStrain, IsWeightedByStiffness) {
  AtRest pair({kX, kY, kX, kY}, {0, 1, 2, 3});
  pair.join(0, 1).join(2, 3);
  pair.springs.get<AngleSpring>()[0].rest_angle -= 0.3;
  pair.springs.get<AngleSpring>()[1].rest_angle += 0.1;
  EXPECT_NEAR(pair.relaxed().rms_strain, std::sqrt((0.09 + 0.01) / 2), 1e-12);
  pair.springs.get<AngleSpring>()[1].stiffness = 3;
  EXPECT_NEAR(pair.relaxed().rms_strain, std::sqrt((0.09 + 3 * 0.01) / 4), 1e-12);
  EXPECT_EQ(AtRest({kX}).relaxed().rms_strain, 0);
}

}  // namespace
}  // namespace spherical_springs::core
