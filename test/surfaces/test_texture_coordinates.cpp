// Texture coordinates: places of points, and faces cut so that each lies in the texture as it lies
// on the sphere.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "support/mesh_scenes.h"
#include "surfaces/placement.h"
#include "surfaces/texture_coordinates.h"

namespace spherical_springs::mesh {
namespace {

constexpr Projection kAll[] = {Projection::longitude_latitude, Projection::equal_area_cylinder,
                               Projection::equal_area_octahedron};

Vector3 at(double longitude, double latitude) {
  const double degree = core::kPi / 180;
  return {std::cos(latitude * degree) * std::cos(longitude * degree),
          std::cos(latitude * degree) * std::sin(longitude * degree), std::sin(latitude * degree)};
}

void expectPlace(const Eigen::Vector2d& expected, Projection projection, const Vector3& p,
                 const Side& side = {1, 1, 1}) {
  EXPECT_TRUE(placeOf(projection, p, side).isApprox(expected, 1e-14))
      << placeOf(projection, p, side).transpose() << " and not " << expected.transpose();
}

TEST(Projection, PutsLongitudeAndLatitude) {
  const auto projection = Projection::longitude_latitude;
  expectPlace({0.5, 0.5}, projection, at(0, 0));
  expectPlace({0.75, 0.75}, projection, at(90, 45));
  expectPlace({0.25, 0.25}, projection, at(-90, -45));
  expectPlace({1, 0.5}, projection, {-1, 0, 0}, {1, 1, 1});
  expectPlace({0, 0.5}, projection, {-1, 0, 0}, {1, -1, 1});
}

TEST(Projection, PutsHeightsByAreaOnACylinder) {
  expectPlace({0.75, 0.75}, Projection::equal_area_cylinder, at(90, 30));
  expectPlace({0.25, 0.25}, Projection::equal_area_cylinder, at(-90, -30));
}

TEST(Projection, UnfoldsAnOctahedron) {
  const auto projection = Projection::equal_area_octahedron;
  expectPlace({0.5, 0.5}, projection, {0, 0, 1});
  expectPlace({1, 0.5}, projection, {1, 0, 0});
  expectPlace({0.5, 0}, projection, {0, -1, 0}, {1, -1, 1});
  expectPlace({1, 1}, projection, {0, 0, -1}, {1, 1, -1});
  expectPlace({0, 1}, projection, {0, 0, -1}, {-1, 1, -1});
  expectPlace({0.25, 0.25}, projection, at(-135, 0), {-1, -1, 1});
}

TEST(Projection, IsNamed) {
  EXPECT_EQ(Projection::equal_area_octahedron, projection("equal-area-octahedron"));
  EXPECT_THROW(projection("mercator"), std::invalid_argument);
}

double signedArea(const TexturedSurface& texture, Eigen::Index f) {
  const auto corner = [&](int k) { return texture.places.col(texture.corners(k, f)); };
  const Eigen::Vector2d ab = corner(1) - corner(0), ac = corner(2) - corner(0);
  return (ab.x() * ac.y() - ab.y() * ac.x()) / 2;
}

/// A sphere whose poles and seam fall inside of faces, on vertices (pole), or on edges of a seam.
std::vector<TriangleMesh> spheres() {
  std::vector<TriangleMesh> result;
  const TriangleMesh sphere = mesh_scenes::icosphere(3);
  result.push_back(sphere);  // with vertices in all coordinate planes
  TriangleMesh turned = sphere;
  turned.vertices =
      Eigen::Quaterniond(0.3, 0.4, -0.7, 0.5).normalized().toRotationMatrix() * sphere.vertices;
  result.push_back(turned);
  TriangleMesh on_pole = sphere;
  on_pole.vertices = placed(sphere, sphere.vertices, {Vector3(0.3, 0.5, 0.9), {}});
  result.push_back(on_pole);
  TriangleMesh coarse = mesh_scenes::icosphere(0);
  coarse.vertices = placed(coarse, turned.vertices.leftCols(12), {{}, Vector3(1, 2, 3)});
  result.push_back(coarse);
  return result;
}

TEST(TextureCoordinates, CoverTheTextureOnceWithoutAFaceTurnedOver) {
  for (const Projection projection : kAll) {
    for (const TriangleMesh& sphere : spheres()) {
      const TexturedSurface texture = textured(sphere, sphere.vertices, projection);
      const Eigen::Index count = sphere.vertices.cols();
      EXPECT_EQ(sphere.vertices, texture.surface.vertices.leftCols(count));
      EXPECT_GE(texture.places.minCoeff(), 0);
      EXPECT_LE(texture.places.maxCoeff(), 1);
      double area = 0;
      for (Eigen::Index f = 0; f < texture.corners.cols(); ++f) {
        EXPECT_GT(signedArea(texture, f), -1e-15) << f;
        area += signedArea(texture, f);
      }
      // A face is flat in the texture, and at a pole a triangle in the place of a strip.
      EXPECT_NEAR(1, area, count < 100 ? 0.25 : 0.05) << static_cast<int>(projection);
      EXPECT_LE(area, 1 + 1e-12);
      EXPECT_NEAR(faceAreas(sphere).sum(), faceAreas(texture.surface).sum(), 1e-12);
    }
  }
}

/// The direction that a place in the texture shows.
Vector3 directionOf(Projection projection, const Eigen::Vector2d& place) {
  const double longitude = (place.x() - 0.5) * 360;
  if (projection == Projection::longitude_latitude) {
    return at(longitude, (place.y() - 0.5) * 180);
  }
  return at(longitude, std::asin(2 * place.y() - 1) * 180 / core::kPi);
}

TEST(TextureCoordinates, OfEachCornerAreThoseOfItsPoint) {
  for (const Projection projection :
       {Projection::longitude_latitude, Projection::equal_area_cylinder}) {
    for (const TriangleMesh& sphere : spheres()) {
      const TexturedSurface texture = textured(sphere, sphere.vertices, projection);
      for (Eigen::Index f = 0; f < texture.corners.cols(); ++f) {
        for (int k = 0; k < 3; ++k) {
          const Vector3 shown = directionOf(projection, texture.places.col(texture.corners(k, f)));
          const Vector3 point = texture.surface.vertices.col(texture.surface.faces(k, f));
          EXPECT_LT((shown - point.normalized()).norm(), 1e-6);
        }
      }
    }
  }
}

TEST(TextureCoordinates, OfAPoleAreHalfwayBetweenTheOtherCorners) {
  TriangleMesh face{Points(3, 3), Faces(3, 1)};
  face.vertices << at(20, 80), at(60, 80), Vector3(0, 0, 1);
  face.faces << 0, 1, 2;
  const TexturedSurface texture = textured(face, face.vertices, Projection::longitude_latitude);
  ASSERT_EQ(1, texture.corners.cols());
  double highest = 0, u = 0;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector2d place = texture.places.col(texture.corners(k, 0));
    if (place.y() > highest) {
      highest = place.y();
      u = place.x();
    }
  }
  EXPECT_EQ(1, highest);
  EXPECT_NEAR(0.5 + 40. / 360, u, 1e-14);
}

TEST(TextureCoordinates, OfAFaceAcrossTheSeamAreOnBothSides) {
  TriangleMesh face{Points(3, 3), Faces(3, 1)};
  face.vertices << at(170, 0), at(-170, 0), at(180, 10);
  face.faces << 0, 1, 2;
  const TexturedSurface texture = textured(face, face.vertices, Projection::longitude_latitude);
  EXPECT_EQ(2, texture.corners.cols());
  EXPECT_EQ(4, texture.surface.vertices.cols());
  for (Eigen::Index f = 0; f < 2; ++f) EXPECT_GT(signedArea(texture, f), 0);
}

TEST(TextureCoordinates, OfAnEqualAreaProjectionSpreadNoTexels) {
  const TriangleMesh sphere = mesh_scenes::icosphere(5);
  const auto spread = [&](Projection projection) {
    return spreadOfTexelDensity(textured(sphere, sphere.vertices, projection));
  };
  EXPECT_LT(spread(Projection::equal_area_octahedron), 0.02);
  EXPECT_LT(spread(Projection::equal_area_cylinder), 0.1);
  // The logarithm of 1 / cos(latitude) has the variance 1 - pi^2 / 12 over the sphere.
  EXPECT_NEAR(std::sqrt(1 - core::kPi * core::kPi / 12), spread(Projection::longitude_latitude),
              0.02);
}

TEST(Placement, PutsTheFarthestVerticesWhereTheyAreAskedFor) {
  const TriangleMesh sphere = mesh_scenes::icosphere(3);
  const Points map =
      Eigen::Quaterniond(0.1, 0.2, 0.3, 0.4).normalized().toRotationMatrix() * sphere.vertices;
  Eigen::Index top, front;
  sphere.vertices.row(2).maxCoeff(&top);
  (-sphere.vertices.row(1)).maxCoeff(&front);
  const Points both = placed(sphere, map, {Vector3(0, 0, 5), Vector3(0, -1e-3, 0)});
  EXPECT_EQ(Vector3(0, 0, 1), both.col(top));
  EXPECT_NEAR(0, both(1, front), 1e-15);
  EXPECT_GT(both(0, front), 0);
  EXPECT_EQ(Vector3(1, 0, 0), placed(sphere, map, {{}, Vector3(0, -1, 0)}).col(front));
  // A rotation, which keeps what the map is.
  EXPECT_NEAR(0, (both.transpose() * both - map.transpose() * map).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_EQ(map, placed(sphere, map, {}));
}

TEST(Placement, TakesTwoVerticesThatMayLieOppositeEachOther) {
  const TriangleMesh sphere = mesh_scenes::icosphere(1);
  const Vector3 up(0, 0, 1);
  EXPECT_THROW(requireTwoVertices(sphere, {up, Vector3(0, 0, 2)}), std::invalid_argument);
  EXPECT_NO_THROW(requireTwoVertices(sphere, {up, -up}));
  Eigen::Index top;
  sphere.vertices.row(2).maxCoeff(&top);
  const Points result = placed(sphere, sphere.vertices, {up, -up});
  EXPECT_EQ(up, result.col(top));
  EXPECT_TRUE(result.allFinite());
}

}  // namespace
}  // namespace spherical_springs::mesh
