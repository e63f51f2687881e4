#include <gtest/gtest.h>

#include "support/relaxation_scenes.h"
#include "system/alignment.h"

namespace spherical_springs::core {
namespace {

using testing::positionsOf;

Eigen::Matrix3d turn(double angle, const Vector3& axis) {
  return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

Points randomPoints(unsigned seed, Eigen::Index count) {
  testing::Random random(seed);
  Points points(3, count);
  for (Eigen::Index i = 0; i < count; ++i) points.col(i) = random.unitVector();
  return points;
}

/// Particles `first` to `last`, each joined with the next.
void addChain(std::uint32_t first, std::uint32_t last, SpringLists& springs) {
  for (std::uint32_t i = first; i < last; ++i) {
    springs.get<AngleSpring>().push_back(testing::angleSpring(i, i + 1, 1));
  }
}

System systemOf(const Points& points, const SpringLists& springs,
                const std::vector<std::uint32_t>& pins = {}) {
  std::vector<Particle> particles;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    particles.push_back(testing::particleAt(points.col(i)));
  }
  return System(testing::pinnedScene(testing::sceneOf(particles, springs), pins), {});
}

double distance(const Points& a, const Points& b) { return (a - b).cwiseAbs().maxCoeff(); }

TEST(Alignment, BringsARotatedSceneBack) {
  const Points before = randomPoints(1, 12);
  SpringLists springs;
  addChain(0, 11, springs);
  const System system = systemOf(before, springs);
  for (const double angle : {1e-9, 1e-3, 1., 3., kPi}) {
    const Points after = aligned(system, before, turn(angle, {1, 2, -3}) * before);
    EXPECT_LT(distance(after, before), 4e-15) << angle;
    EXPECT_LT((after.colwise().norm().array() - 1).abs().maxCoeff(), 4e-16);
  }
}

TEST(Alignment, KeepsAnglesAndMinimisesTheDistance) {
  const Points before = randomPoints(2, 8), after = randomPoints(3, 8);
  SpringLists springs;
  addChain(0, 7, springs);
  const Points result = aligned(systemOf(before, springs), before, after);
  EXPECT_LT((result.transpose() * result - after.transpose() * after).norm(), 1e-14);
  EXPECT_NEAR(tripleProduct(result.col(0), result.col(1), result.col(2)),
              tripleProduct(after.col(0), after.col(1), after.col(2)), 1e-14);
  const double least = (result - before).squaredNorm();
  for (int axis = 0; axis < 3; ++axis) {
    for (const double angle : {0.01, -0.01, 1., -1., kPi}) {
      EXPECT_GT((turn(angle, Vector3::Unit(axis)) * result - before).squaredNorm(), least);
    }
  }
}

TEST(Alignment, TurnsEachComponentByItself) {
  const Points before = randomPoints(4, 13);
  SpringLists springs;
  addChain(0, 4, springs);
  springs.get<SolidAngleSpring>() = {testing::solidAngleSpring(5, 6, 7, 1),
                                     testing::solidAngleSpring(7, 8, 9, 1)};
  springs.get<OrientedAngleSpring>() = testing::threeOrientedArcs().get<OrientedAngleSpring>();
  springs.get<OrientedAngleSpring>().resize(1);
  springs.get<OrientedAngleSpring>()[0].particles = {10, 11, 12};
  Points after = before;
  after.leftCols(5) = turn(0.5, {1, 0, 2}) * before.leftCols(5);
  after.middleCols(5, 5) = turn(-1.5, {0, 1, 2}) * before.middleCols(5, 5);
  after.rightCols(3) = turn(2, {-1, 1, 1}) * before.rightCols(3);
  EXPECT_LT(distance(aligned(systemOf(before, springs), before, after), before), 4e-15);
}

TEST(Alignment, TurnsAboutAPin) {
  const Points before = randomPoints(5, 9);
  SpringLists springs;
  addChain(0, 8, springs);
  const System system = systemOf(before, springs, {3});
  for (const double angle : {1e-6, 0.7, -3.}) {
    const Points result = aligned(system, before, turn(angle, before.col(3)) * before);
    EXPECT_LT(distance(result, before), 4e-15) << angle;
  }
  // For any other change the result is the best of all turns about the pin.
  Points after = randomPoints(6, 9);
  after.col(3) = before.col(3);
  const Points result = aligned(system, before, after);
  EXPECT_EQ(Vector3(result.col(3)), Vector3(before.col(3)));
  EXPECT_LT((result.transpose() * result - after.transpose() * after).norm(), 1e-14);
  for (const double angle : {0.01, -0.01, 2., kPi}) {
    EXPECT_GT((turn(angle, before.col(3)) * result - before).squaredNorm(),
              (result - before).squaredNorm());
  }
}

TEST(Alignment, TurnsAboutAnAntipodalPairOfPins) {
  Points before = randomPoints(7, 9);
  before.col(6) = -before.col(3);
  SpringLists springs;
  addChain(0, 8, springs);
  const Points after = turn(0.4, before.col(3)) * before;
  const Points result = aligned(systemOf(before, springs, {3, 6}), before, after);
  EXPECT_LT(distance(result, before), 4e-15);
}

TEST(Alignment, DoesNotTurnWhatTwoPinsHold) {
  const Points before = randomPoints(8, 14);
  SpringLists springs;
  addChain(0, 8, springs);
  addChain(9, 13, springs);  // another component, without pins
  Points after = turn(0.3, {1, 1, 0}) * before;
  after.col(2) = before.col(2);
  after.col(5) = before.col(5);
  const Points result = aligned(systemOf(before, springs, {2, 5}), before, after);
  EXPECT_LT(distance(result.leftCols(9), after.leftCols(9)), 4e-16);
  EXPECT_LT(distance(result.rightCols(5), before.rightCols(5)), 4e-15);
}

TEST(Alignment, BringsALoneParticleBack) {
  const Points before = randomPoints(9, 2), after = randomPoints(10, 2);
  EXPECT_LT(distance(aligned(systemOf(before, {}), before, after), before), 4e-15);
}

}  // namespace
}  // namespace spherical_springs::core
