#include <gtest/gtest.h>

#include <cmath>

#include "node/markers.h"
#include "support/scenes.h"

namespace spherical_springs {
namespace {

using core::Vector3;
using visualization_msgs::Marker;

Vector3 vectorOf(const geometry_msgs::Point& p) { return {p.x, p.y, p.z}; }

template <class Make>
Marker drawn(const core::Scene& scene, const Make& make, double radius = 1) {
  return make(core::System(scene, {}), core::testing::positionsOf(scene), radius);
}

/// An octant's corners, where springs of every kind are at twice what they are at rest.
core::Scene octant() {
  core::SpringLists springs;
  springs.get<core::AngleSpring>() = {core::testing::angleSpring(0, 1, core::kPi / 4)};
  springs.get<core::SolidAngleSpring>() = {core::testing::solidAngleSpring(0, 1, 2, core::kPi / 4)};
  core::OrientedAngleSpring oriented;
  oriented.particles = {1, 2, 0};
  oriented.rest_angle = core::kPi / 4;
  oriented.stiffness = 1;
  springs.get<core::OrientedAngleSpring>() = {oriented};
  return core::testing::sceneOf(
      {core::testing::particleAt(Vector3::UnitX()), core::testing::particleAt(Vector3::UnitY()),
       core::testing::particleAt(Vector3::UnitZ())},
      springs);
}

double luminance(const std_msgs::ColorRGBA& c) {
  return 0.2126 * std::pow(c.r, 2.2) + 0.7152 * std::pow(c.g, 2.2) + 0.0722 * std::pow(c.b, 2.2);
}

TEST(StrainColour, IsBlueWhiteAndOrange) {
  const auto smaller = strainColour(-1), at_rest = strainColour(0), larger = strainColour(1);
  EXPECT_GT(smaller.b, smaller.r + 0.5);
  EXPECT_GT(larger.r, larger.b + 0.5);
  EXPECT_EQ(at_rest.r, 1);
  EXPECT_EQ(at_rest.g, 1);
  EXPECT_EQ(at_rest.b, 1);
  EXPECT_EQ(strainColour(-5), smaller);
  EXPECT_FLOAT_EQ(strainColour(0.5).b, 0.5);
}

TEST(StrainColour, StandsOutFromTheSphere) {
  const double sphere = luminance(sphereMarker(1).color);
  for (double strain = -1; strain <= 1; strain += 0.1) {
    EXPECT_GT((luminance(strainColour(strain)) + 0.05) / (sphere + 0.05), 3) << strain;
  }
}

TEST(Markers, SphereIsJustBelowWhatLiesOnIt) {
  const Marker sphere = sphereMarker(2);
  EXPECT_EQ(sphere.type, Marker::SPHERE);
  EXPECT_LT(sphere.scale.x, 2 * 2);
  EXPECT_GT(sphere.scale.x, 2 * 2 * 0.99);
}

TEST(Markers, ParticlesStandInTheOrderOfIds) {
  const Marker particles = drawn(octant(), particlesMarker, 3);
  EXPECT_EQ(particles.type, Marker::SPHERE_LIST);
  ASSERT_EQ(particles.points.size(), 3u);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(vectorOf(particles.points[i]), 3 * Vector3::Unit(i));
  EXPECT_TRUE(particles.colors.empty()) << "one colour will do";
}

TEST(Markers, PinnedParticlesAreBlack) {
  core::Scene scene = octant();
  core::Particle pinned = core::testing::particleAt({1, 1, 1});
  pinned.pinned = true;
  scene.addParticles({pinned});
  const Marker particles = drawn(scene, particlesMarker);
  ASSERT_EQ(particles.colors.size(), 4u);
  EXPECT_EQ(particles.colors[0].r, 1);
  EXPECT_EQ(particles.colors[3].r, 0);
}

TEST(Markers, ArcsLieOnTheSphereToTheEye) {
  const Marker arcs = drawn(octant(), arcsMarker, 3);
  EXPECT_EQ(arcs.type, Marker::LINE_LIST);
  ASSERT_EQ(arcs.points.size(), arcs.colors.size());
  ASSERT_GT(arcs.points.size(), 0u);
  double length = 0;
  for (std::size_t i = 0; i < arcs.points.size(); i += 2) {
    const Vector3 a = vectorOf(arcs.points[i]), b = vectorOf(arcs.points[i + 1]);
    EXPECT_NEAR(a.norm(), 3, 1e-14);
    EXPECT_GT(((a + b) / 2).norm(), 3 - 0.11 * arcs.scale.x);
    length += (a - b).norm();
  }
  EXPECT_NEAR(length, 3 * core::kPi, 0.01) << "two quarters of a circle";
  EXPECT_EQ(vectorOf(arcs.points.front()), Vector3(3, 0, 0));
  EXPECT_EQ(vectorOf(arcs.points.back()), Vector3(0, 0, 3));
}

TEST(Markers, TrianglesLieBetweenTheSphereAndTheArcs) {
  const Marker triangles = drawn(octant(), trianglesMarker);
  EXPECT_EQ(triangles.type, Marker::TRIANGLE_LIST);
  ASSERT_EQ(triangles.points.size(), triangles.colors.size());
  double area = 0;
  for (std::size_t i = 0; i < triangles.points.size(); i += 3) {
    const Vector3 a = vectorOf(triangles.points[i]), b = vectorOf(triangles.points[i + 1]),
                  c = vectorOf(triangles.points[i + 2]);
    EXPECT_GT(((a + b + c) / 3).norm(), sphereMarker(1).scale.x / 2);
    EXPECT_LT(a.norm(), 1);
    area += (b - a).cross(c - a).dot(a) / 2;
  }
  EXPECT_NEAR(area, core::kPi / 2, 0.02) << "and face outwards";
}

TEST(Markers, SpringsHaveTheColourOfTheirStrain) {
  for (const bool arcs : {true, false}) {
    const auto expected = strainColour(0.5, arcs ? 1 : 0.75);
    for (const auto& colour : drawn(octant(), arcs ? arcsMarker : trianglesMarker).colors) {
      EXPECT_NEAR(colour.r, expected.r, 1e-6);
      EXPECT_NEAR(colour.g, expected.g, 1e-6);
      EXPECT_NEAR(colour.b, expected.b, 1e-6);
    }
  }
}

TEST(Markers, OfNothingAreDeleted) {
  EXPECT_EQ(drawn(core::Scene(), particlesMarker).action, Marker::DELETE);
  EXPECT_EQ(drawn(core::Scene(), arcsMarker).action, Marker::DELETE);
  EXPECT_EQ(drawn(core::Scene(), trianglesMarker).action, Marker::DELETE);
  EXPECT_EQ(drawn(octant(), arcsMarker).action, Marker::ADD);
}

TEST(Markers, OfVeryManyLongSpringsStaySmall) {
  core::Scene scene = octant();
  core::SpringLists springs;
  springs.get<core::SolidAngleSpring>().assign(5'000, core::testing::solidAngleSpring(0, 1, 2, 1));
  scene.addSprings(springs, core::testing::positionsOf(scene));
  EXPECT_LT(drawn(scene, trianglesMarker).points.size(), 3 * 6e5);
}

}  // namespace
}  // namespace spherical_springs
