#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "spherical_springs/maps/distortion.h"
#include "support/mesh_scenes.h"

namespace spherical_springs::mesh {
namespace {

/// The corners' angles of a flat triangle by the law of cosines.
Vector3 flatAngles(const Vector3& a, const Vector3& b, const Vector3& c) {
  const auto at = [](const Vector3& p, const Vector3& q, const Vector3& r) {
    const double pq = (q - p).norm(), pr = (r - p).norm(), qr = (r - q).norm();
    return std::acos((pq * pq + pr * pr - qr * qr) / (2 * pq * pr));
  };
  return {at(a, b, c), at(b, c, a), at(c, a, b)};
}

/// Area of a spherical triangle from its sides (L'Huilier's theorem).
double areaFromSides(const Vector3& a, const Vector3& b, const Vector3& c) {
  const double x = std::acos(b.dot(c)), y = std::acos(c.dot(a)), z = std::acos(a.dot(b));
  const double s = (x + y + z) / 2;
  return 4 * std::atan(std::sqrt(std::tan(s / 2) * std::tan((s - x) / 2) * std::tan((s - y) / 2) *
                                 std::tan((s - z) / 2)));
}

/// A bumpy ball and a map of it, both rough.
struct Sample {
  TriangleMesh surface = mesh_scenes::icosphere(2);
  Points map = surface.vertices;
  Eigen::VectorXd shares = Eigen::VectorXd(surface.faces.cols());
  Sample() {
    std::mt19937 generator(1);
    const auto noise = [&] { return 0.1 * (generator() / 2147483648. - 1); };
    for (Eigen::Index i = 0; i < map.cols(); ++i) {
      map.col(i) = (map.col(i) + Vector3(noise(), noise(), noise())).normalized();
      surface.vertices.col(i) *= 3 + noise();
    }
    for (Eigen::Index f = 0; f < shares.size(); ++f) shares[f] = 1 + noise();
    shares *= 4 * core::kPi / shares.sum();
  }
  Vector3 corner(const Points& places, Eigen::Index face, int i) const {
    return places.col(surface.faces(i, face));
  }
};

TEST(Distortion, OfEachFaceIsWhatTextbooksSay) {
  const Sample s;
  const FaceDistortion found = faceDistortion(s.surface, s.shares, s.map);
  for (Eigen::Index f = 0; f < s.surface.faces.cols(); ++f) {
    const auto corners = [&](const Points& p, auto function) {
      return function(s.corner(p, f, 0), s.corner(p, f, 1), s.corner(p, f, 2));
    };
    const double area = corners(s.map, areaFromSides);
    EXPECT_NEAR(area, found.areas[f], 1e-12);
    EXPECT_NEAR(std::log(area / s.shares[f]), found.log_area_ratios[f], 1e-9);
    const Vector3 change = corners(s.map, flatAngles) - corners(s.surface.vertices, flatAngles);
    EXPECT_LT((change - found.angle_changes.col(f)).norm(), 1e-9);
  }
}

TEST(Distortion, IsSummedUpAsItsNamesSay) {
  const Sample s;
  const FaceDistortion faces = faceDistortion(s.surface, s.shares, s.map);
  double sum = 0, sum_of_squares = 0, magnitudes = 0, worst = 0, angles = 0, worst_angle = 0;
  const auto count = static_cast<double>(faces.areas.size());
  for (Eigen::Index f = 0; f < faces.log_area_ratios.size(); ++f) {
    const double ratio = faces.log_area_ratios[f];
    sum += ratio;
    sum_of_squares += ratio * ratio;
    magnitudes += std::abs(ratio);
    worst = std::max(worst, std::abs(ratio));
  }
  for (Eigen::Index f = 0; f < faces.angle_changes.cols(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const double change = faces.angle_changes(k, f);
      angles += std::abs(change);
      worst_angle = std::max(worst_angle, std::abs(change));
    }
  }
  const Distortion found = summary(faces);
  EXPECT_NEAR(std::sqrt(sum_of_squares / count - sum * sum / count / count), found.spread, 1e-12);
  EXPECT_NEAR(magnitudes / count, found.mean, 1e-12);
  EXPECT_EQ(worst, found.worst);
  EXPECT_NEAR(angles / (3 * count), found.mean_angle, 1e-12);
  EXPECT_EQ(worst_angle, found.worst_angle);
  EXPECT_EQ(0, found.folded);
  EXPECT_NEAR(4 * core::kPi, found.total_area, 1e-12);
}

TEST(Distortion, OfASphereToItselfIsNone) {
  const TriangleMesh sphere = mesh_scenes::icosphere(3);
  Eigen::VectorXd shares(sphere.faces.cols());
  for (Eigen::Index f = 0; f < shares.size(); ++f) {
    const Vector3 a = sphere.vertices.col(sphere.faces(0, f));
    const Vector3 b = sphere.vertices.col(sphere.faces(1, f));
    const Vector3 c = sphere.vertices.col(sphere.faces(2, f));
    shares[f] = areaFromSides(a, b, c);
  }
  const Distortion found = summary(faceDistortion(sphere, shares, sphere.vertices));
  EXPECT_LT(found.worst, 1e-10);
  EXPECT_EQ(0, found.worst_angle);
}

TEST(Distortion, CountsFoldedFaces) {
  Sample s;
  Points& map = s.map;
  // One vertex across an edge of the ring of faces about it.
  const Vector3 a = s.corner(map, 0, 0), b = s.corner(map, 0, 1), c = s.corner(map, 0, 2);
  map.col(s.surface.faces(0, 0)) = (0.6 * (b + c) - 0.2 * a).normalized();
  const Distortion found = summary(faceDistortion(s.surface, s.shares, map));
  EXPECT_GE(found.folded, 1);
  EXPECT_NEAR(4 * core::kPi, found.total_area, 1e-12);
}

TEST(Distortion, IsFiniteWhereFacesHaveNoArea) {
  Sample s;
  s.map.col(s.surface.faces(0, 0)) = s.map.col(s.surface.faces(1, 0));
  s.surface.vertices.col(s.surface.faces(0, 0)) = s.surface.vertices.col(s.surface.faces(1, 0));
  const FaceDistortion faces = faceDistortion(s.surface, s.shares, s.map);
  EXPECT_TRUE(faces.log_area_ratios.allFinite());
  EXPECT_TRUE(faces.angle_changes.allFinite());
  EXPECT_GE(summary(faces).folded, 2);
}

TEST(Distortion, RefusesSizesThatDoNotFit) {
  const Sample s;
  EXPECT_THROW(faceDistortion(s.surface, s.shares.head(3), s.map), std::invalid_argument);
  EXPECT_THROW(faceDistortion(s.surface, s.shares, s.map.leftCols(3)), std::invalid_argument);
}

}  // namespace
}  // namespace spherical_springs::mesh
