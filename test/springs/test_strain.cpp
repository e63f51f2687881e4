#include <gtest/gtest.h>

#include "spherical_springs/springs/kinds.h"
#include "springs/strain.h"

namespace spherical_springs::core {
namespace {

const Vector3 kX(1, 0, 0), kY(0, 1, 0), kZ(0, 0, 1);

double ofAQuarterTurn(double rest_angle) {
  AngleSpring spring;
  spring.rest_angle = rest_angle;
  return strain(spring, {kX, kY});
}

TEST(Strain, IsTheShareOfTheLarger) {
  EXPECT_NEAR(ofAQuarterTurn(kPi / 4), 0.5, 1e-15);
  EXPECT_NEAR(ofAQuarterTurn(kPi), -0.5, 1e-15);
  EXPECT_NEAR(ofAQuarterTurn(kPi / 2), 0, 1e-15);
  EXPECT_EQ(ofAQuarterTurn(0), 1);
}

TEST(Strain, IsZeroWhereNothingIsWantedAndNothingIsThere) {
  EXPECT_EQ(strain(AngleSpring(), {kX, kX}), 0);
}

TEST(Strain, OfASolidAngle) {
  SolidAngleSpring spring;
  spring.rest_solid_angle = kPi;  // the octant has half of that
  EXPECT_NEAR(strain(spring, {kX, kY, kZ}), -0.5, 1e-15);
  EXPECT_EQ(strain(spring, {kX, kZ, kY}), -1) << "folded";
}

TEST(Strain, OfWhatIsNegativeAtRestIsPositiveWhereItIsLarger) {
  SolidAngleSpring solid_angle;
  solid_angle.rest_solid_angle = -kPi / 4;
  EXPECT_NEAR(strain(solid_angle, {kX, kZ, kY}), 0.5, 1e-15);
  OrientedAngleSpring oriented;
  oriented.rest_angle = -kPi / 4;
  EXPECT_NEAR(strain(oriented, {kX, kZ, kY}), 0.5, 1e-15);
  EXPECT_EQ(strain(oriented, {kX, kY, kZ}), -1) << "the wrong way round";
}

}  // namespace
}  // namespace spherical_springs::core
