#include <gtest/gtest.h>

#include <sstream>
#include <stdexcept>
#include <string>

#include "surfaces/face_files.h"

namespace spherical_springs::mesh {
namespace {

std::string reasonAgainst(const std::string& text, Eigen::Index faces) {
  std::istringstream in(text);
  try {
    readDensities(in, faces);
  } catch (const std::invalid_argument& fault) {
    return fault.what();
  }
  return "taken";
}

TEST(Densities, AreReadInOrder) {
  std::istringstream in("1 2.5\n\n1e-3\r\n");
  EXPECT_EQ(Eigen::Vector3d(1, 2.5, 1e-3), readDensities(in, 3));
}

TEST(Densities, MayBeginWithAByteOrderMark) {
  for (const std::string mark : {"\xEF\xBB\xBF", "\xEF\xBB\xBF\r\n"}) {
    std::istringstream in(mark + "1 2.5");
    EXPECT_EQ(Eigen::Vector2d(1, 2.5), readDensities(in, 2));
  }
  const std::string later = "\xEF\xBB\xBF" + std::string("2");
  EXPECT_EQ("density 1 is " + later + "; allowed: a positive number",
            reasonAgainst("1 " + later, 2));
}

TEST(Densities, AreRefusedUnlessPositiveAndOneAFace) {
  EXPECT_EQ("density 1 is 0; allowed: a positive number", reasonAgainst("1 0 2", 3));
  EXPECT_EQ("density 0 is -1; allowed: a positive number", reasonAgainst("-1 1 2", 3));
  EXPECT_EQ("density 2 is nan; allowed: a positive number", reasonAgainst("1 1 nan", 3));
  EXPECT_EQ("density 2 is inf; allowed: a positive number", reasonAgainst("1 1 inf", 3));
  EXPECT_EQ("density 0 is 1,5; allowed: a positive number", reasonAgainst("1,5", 1));
  EXPECT_EQ("it has 2 numbers; allowed: 3, one a face", reasonAgainst("1 2", 3));
  EXPECT_EQ("it has 4 numbers; allowed: 3, one a face", reasonAgainst("1 2 3 4", 3));
  EXPECT_EQ("it has 0 numbers; allowed: 1, one a face", reasonAgainst("", 1));
}

TEST(Metrics, AreWrittenFaceByFace) {
  FaceDistortion faces{Values(2), Values(2), Points(3, 2)};
  faces.areas << 0.25, -3;
  faces.log_area_ratios << 0.5, 1;
  faces.angle_changes << 1, 4, 2, 5, 3, -6;
  std::ostringstream out;
  writeMetrics(out, Eigen::Vector2d(1, 2), faces);
  EXPECT_EQ(
      "face,share_sr,area_sr,log_area_ratio,angle_change_1_rad,angle_change_2_rad,"
      "angle_change_3_rad\n0,1,0.25,0.5,1,2,3\n1,2,-3,1,4,5,-6\n",
      out.str());
}

}  // namespace
}  // namespace spherical_springs::mesh
