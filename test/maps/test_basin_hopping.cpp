// Patches of maps, and hops of theirs out of minima.
#include <gtest/gtest.h>

#include <set>

#include "maps/basin_hopping.h"
#include "maps/coverage.h"
#include "maps/map_clock.h"
#include "maps/map_descent.h"
#include "spherical_springs/maps/sphere_map.h"
#include "support/hub_shapes.h"

namespace spherical_springs::mesh {
namespace {

/// An icosphere whose faces are to have areas by chance, and the map at which Newton's method ends.
struct Stuck {
  explicit Stuck(int level)
      : mesh(testing::deformedSphere(level, [](const Vector3& p) { return p; })) {
    testing::Random random(5);
    shares.resize(mesh.faces.cols());
    for (Eigen::Index f = 0; f < shares.size(); ++f)
      shares[f] = std::exp(random.between(-1.5, 1.5));
    shares *= 4 * core::kPi / shares.sum();
    MapEnergy energy(mesh.faces, shares, mesh.vertices, 1);
    MapDescent descent(energy, 1);
    int steps = 0;
    descent.run(FaceHessian::exact, 1e-9, [&] { return steps++ < 2000; });
    map = energy.points();
    value = energy.valueHere();
  }

  TriangleMesh mesh;
  Eigen::VectorXd shares;
  Points map;
  double value;
};

double valueOf(const Stuck& stuck, const Points& map) {
  return MapEnergy(stuck.mesh.faces, stuck.shares, map, 1).valueHere();
}

std::set<std::int32_t> freeOf(const Patch& patch) {
  return {patch.vertices.begin(), patch.vertices.begin() + patch.free};
}

TEST(Patch, HasAllFacesRoundItsFreeVerticesAndNoOthers) {
  const Stuck stuck(2);
  PatchCutter cutter(stuck.mesh.faces, stuck.shares, 162);
  const Patch patch = cutter.cut(7, 30);
  const std::set<std::int32_t> free = freeOf(patch);
  EXPECT_GE(patch.free, 30);
  EXPECT_LT(patch.free, 40);
  std::multiset<double> expected;
  for (Eigen::Index f = 0; f < stuck.mesh.faces.cols(); ++f) {
    int count = 0;
    for (int k = 0; k < 3; ++k) count += static_cast<int>(free.count(stuck.mesh.faces(k, f)));
    EXPECT_TRUE(f != 7 || count == 3);
    if (count > 0) expected.insert(stuck.shares[f]);
  }
  const double* shares = patch.shares.data();
  EXPECT_EQ(std::multiset<double>(shares, shares + patch.shares.size()), expected);
  const Points points = patch.of(stuck.map);
  double area = 0;
  for (Eigen::Index f = 0; f < patch.faces.cols(); ++f) {
    const auto corner = [&](int k) { return Vector3(points.col(patch.faces(k, f))); };
    area += core::solidAngle(corner(0), corner(1), corner(2));
  }
  EXPECT_GT(area, 0);
  EXPECT_LT(area, 4 * core::kPi);
}

TEST(Patch, HoldsVerticesOfTooManyFaces) {
  const TriangleMesh mesh = testing::doublePyramid(100);
  const Eigen::VectorXd shares = testing::sharesOf(mesh);
  const Patch patch = PatchCutter(mesh.faces, shares, 102).cut(7, 30);
  EXPECT_GE(patch.free, 30);
  EXPECT_LE(patch.free, 34);
  EXPECT_EQ(freeOf(patch).count(0) + freeOf(patch).count(1), 0u);
  EXPECT_EQ(patch.vertices.size(), patch.free + 4u);
}

TEST(Patch, OthersHaveNoFaceWithItsFreeVertices) {
  const Stuck stuck(2);
  PatchCutter cutter(stuck.mesh.faces, stuck.shares, 162);
  const Patch first = cutter.cut(0, 40);
  std::int32_t cut = first.free;
  for (Eigen::Index f = 0; f < stuck.mesh.faces.cols(); ++f) {
    const Patch other = cutter.cut(f, 10);
    cut += other.free;
    for (const std::int32_t v : other.vertices) EXPECT_EQ(freeOf(first).count(v), 0u);
  }
  EXPECT_GT(cut, 100);
  cutter.begin();
  EXPECT_EQ(cutter.cut(0, 40).vertices, first.vertices);
}

TEST(Patch, ItsEnergyIsThatOfTheMapUpToWhatStays) {
  const Stuck stuck(2);
  PatchCutter cutter(stuck.mesh.faces, stuck.shares, 162);
  const Patch patch = cutter.cut(7, 30);
  const Points before = patch.of(stuck.mesh.vertices);
  MapEnergy energy(patch.faces, patch.shares, before, patch.free, 1);
  energy.evaluate(FaceHessian::exact);
  ASSERT_EQ(energy.gradient().size(), 2 * patch.free);
  const double was = energy.value();
  energy.move(-1e-4 * energy.gradient().normalized());
  const Points after = energy.points();
  EXPECT_EQ(after.rightCols(after.cols() - patch.free),
            before.rightCols(after.cols() - patch.free));
  Points map = stuck.mesh.vertices;
  patch.putInto(map, after);
  EXPECT_NEAR(valueOf(stuck, map) - valueOf(stuck, stuck.mesh.vertices), energy.valueHere() - was,
              1e-9 * was);
  EXPECT_LT(energy.valueHere(), was);
}

TEST(Patch, NewtonsMethodEndsAtAMinimumOfIt) {
  const Stuck stuck(2);
  PatchCutter cutter(stuck.mesh.faces, stuck.shares, 162);
  const Patch patch = cutter.cut(7, 30);
  MapEnergy energy(patch.faces, patch.shares, patch.of(stuck.mesh.vertices), patch.free, 1);
  MapDescent descent(energy, 1);
  int steps = 0;
  descent.run(FaceHessian::exact, 1e-14, [&] { return steps++ < 200; });
  energy.evaluate(FaceHessian::exact);
  const double scale = energy.mass().head(patch.free).cwiseSqrt().minCoeff();
  EXPECT_LT(energy.gradient().norm() / scale, 1e-6);
}

TEST(BasinHopping, LeavesMinimaOfNewtonsMethod) {
  const Stuck stuck(3);
  Points map = stuck.map;
  BasinHopping hopping(stuck.mesh.faces, stuck.shares, 642, 0, 2);
  double left = 1;
  for (int round = 0; round < 12; ++round) {
    const double fall = hopping.hop(map);
    EXPECT_GE(fall, 0);
    left *= 1 - fall;
  }
  EXPECT_TRUE(coversOnce(stuck.mesh.faces, map));
  EXPECT_LT(left, 0.3);
  EXPECT_NEAR(valueOf(stuck, map), left * stuck.value, 1e-9 * stuck.value);
}

TEST(BasinHopping, IsTheSameForAnyNumberOfThreads) {
  const Stuck stuck(2);
  Points one = stuck.map, two = stuck.map;
  BasinHopping(stuck.mesh.faces, stuck.shares, 162, 0, 1).hop(one);
  BasinHopping(stuck.mesh.faces, stuck.shares, 162, 0, 2).hop(two);
  EXPECT_NE(one, stuck.map);
  EXPECT_EQ(one, two);
}

TEST(BasinHopping, StaysAsLowAsItHasComeWhenTimeIsOver) {
  const Stuck stuck(2);
  for (const int checks : {0, 10, 100}) {
    int left = checks;
    Points map = stuck.map;
    BasinHopping hopping(stuck.mesh.faces, stuck.shares, 162, 0, 1, [&] {
      if (--left < 0) throw TimeIsOver();
    });
    EXPECT_GE(hopping.hop(map), 0);
    EXPECT_EQ(map == stuck.map, checks == 0);
    EXPECT_TRUE(coversOnce(stuck.mesh.faces, map));
    EXPECT_LT(left, 0);
  }
}

TEST(BasinHopping, LeavesTheMapAloneWhereACheckpointThrows) {
  const Stuck stuck(2);
  int left = 100;
  Points map = stuck.map;
  BasinHopping hopping(stuck.mesh.faces, stuck.shares, 162, 0, 1, [&] {
    if (--left < 0) throw std::domain_error("enough");
  });
  EXPECT_THROW(hopping.hop(map), std::domain_error);
  EXPECT_EQ(map, stuck.map);
}

TEST(BasinHopping, BearsMeshesOfAFewFaces) {
  const TriangleMesh mesh = testing::tetrahedron();
  Eigen::VectorXd shares(4);
  shares << 1, 2, 3, 4;
  shares *= 4 * core::kPi / shares.sum();
  Points map = mesh.vertices.colwise().normalized();
  if (!coversOnce(mesh.faces, map)) GTEST_FAIL() << "the tetrahedron is not about its centre";
  EXPECT_GE(BasinHopping(mesh.faces, shares, 4, 0, 1).hop(map), 0);
  EXPECT_TRUE(coversOnce(mesh.faces, map));
}

}  // namespace
}  // namespace spherical_springs::mesh
