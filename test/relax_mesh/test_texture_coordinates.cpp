#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "relax_mesh/texture_coordinates.h"
#include "support/mesh_scenes.h"

namespace spherical_springs::mesh {
namespace {

Vector3 at(double longitude, double latitude) {
  const double degree = core::kPi / 180;
  return {std::cos(latitude * degree) * std::cos(longitude * degree),
          std::cos(latitude * degree) * std::sin(longitude * degree), std::sin(latitude * degree)};
}

struct OneFace {
  Points sphere = Points(3, 3);
  Faces faces = Faces(3, 1);
  OneFace(const Vector3& a, const Vector3& b, const Vector3& c) {
    sphere << a, b, c;
    faces << 0, 1, 2;
  }
  Eigen::Matrix<double, 2, 3> corners() const {
    const TextureCoordinates texture = longitudeLatitude(sphere, faces);
    Eigen::Matrix<double, 2, 3> result;
    for (int i = 0; i < 3; ++i) result.col(i) = texture.places.col(texture.corners(i, 0));
    return result;
  }
};

double signedArea(const Eigen::Matrix<double, 2, 3>& triangle) {
  const Eigen::Vector2d ab = triangle.col(1) - triangle.col(0);
  const Eigen::Vector2d ac = triangle.col(2) - triangle.col(0);
  return (ab.x() * ac.y() - ab.y() * ac.x()) / 2;
}

TEST(TextureCoordinates, AreLongitudeAndLatitude) {
  Eigen::Matrix<double, 2, 3> expected;
  expected << 0.5, 0.75, 0.25, 0.5, 0.75, 0.25;
  EXPECT_TRUE(OneFace(at(0, 0), at(90, 45), at(-90, -45)).corners().isApprox(expected, 1e-14));
}

TEST(TextureCoordinates, GoOnBeyondTheSeam) {
  Eigen::Matrix<double, 2, 3> expected;
  expected << 350, 370, 360, 90, 90, 100;
  expected.row(0) /= 360;
  expected.row(1) /= 180;
  // From 170 degrees over 180 to -170, which is 190; longitude -180 is u = 0.
  EXPECT_TRUE(OneFace(at(170, 0), at(-170, 0), at(180, 10)).corners().isApprox(expected, 1e-12));
}

TEST(TextureCoordinates, OfAPoleAreHalfwayBetweenTheOtherCorners) {
  const auto north = OneFace(at(20, 80), at(60, 80), Vector3(0, 0, 1)).corners();
  EXPECT_NEAR(0.5 + 40. / 360, north(0, 2), 1e-14);
  EXPECT_EQ(1, north(1, 2));
  const auto south = OneFace(at(-170, -80), at(170, -80), Vector3(0, 0, -1)).corners();
  EXPECT_NEAR(1, south(0, 2), 1e-14);
  EXPECT_EQ(0, south(1, 2));
}

TEST(TextureCoordinates, OfAWholeSphereCoverTheChartOnce) {
  // With poles and seam where they fall, and with vertices on the poles.
  for (const bool on_poles : {false, true}) {
    TriangleMesh sphere = mesh_scenes::icosphere(4);
    const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(
        sphere.vertices.col(0), on_poles ? Vector3(0, 0, 1) : Vector3(1, 2, 3));
    sphere.vertices = turn.toRotationMatrix() * sphere.vertices;
    if (on_poles) {
      for (Eigen::Index i = 0; i < sphere.vertices.cols(); ++i) {
        auto vertex = sphere.vertices.col(i);
        if (vertex.head<2>().norm() < 1e-9) vertex << 0, 0, (vertex.z() > 0 ? 1 : -1);
      }
    }
    const TextureCoordinates texture = longitudeLatitude(sphere.vertices, sphere.faces);
    double area = 0;
    int folded = 0, wide = 0;
    for (Eigen::Index f = 0; f < sphere.faces.cols(); ++f) {
      Eigen::Matrix<double, 2, 3> triangle;
      for (int i = 0; i < 3; ++i) {
        triangle.col(i) = texture.places.col(texture.corners(i, f));
        const double error =
            std::remainder(triangle(0, i) - texture.places(0, sphere.faces(i, f)), 1);
        if (!sphere.vertices.col(sphere.faces(i, f)).head<2>().isZero(0)) {
          EXPECT_NEAR(0, error, 1e-14);
        }
      }
      wide += triangle.row(0).maxCoeff() - triangle.row(0).minCoeff() > 0.5 + 1e-12;
      const double signed_area = signedArea(triangle);
      area += signed_area;
      folded += signed_area <= 0;
    }
    // Two faces have a pole inside where it is on no vertex.
    EXPECT_LE(folded, on_poles ? 0 : 2) << on_poles;
    EXPECT_LE(wide, on_poles ? 0 : 2) << on_poles;
    EXPECT_NEAR(1, area, on_poles ? 0.03 : 0.06) << on_poles;
    // Only what lies on the seam or on a pole is there twice.
    EXPECT_LT(texture.places.cols(), sphere.vertices.cols() + 120);
    EXPECT_GT(texture.places.cols(), sphere.vertices.cols() + 20);
  }
}

}  // namespace
}  // namespace spherical_springs::mesh
