#include <gtest/gtest.h>
#include <ros/package.h>

#include <stdexcept>

#include "relax_mesh/input_path.h"

namespace spherical_springs::relax_mesh {
namespace {

std::string reasonAgainst(const std::string& text) {
  try {
    inputPath(text);
  } catch (const std::invalid_argument& fault) {
    return fault.what();
  }
  return "taken";
}

TEST(InputPath, OfAFileIsKept) { EXPECT_EQ("/a/b c%20.obj", inputPath("/a/b c%20.obj")); }

TEST(InputPath, OfAUrlIsDecoded) {
  EXPECT_EQ("/a/b c.obj", inputPath("file:///a/b%20c.obj"));
  EXPECT_EQ("/a/%2.obj", inputPath("file://localhost/a/%2.obj"));
  EXPECT_EQ("/a/100%", inputPath("file:///a/100%"));
}

TEST(InputPath, OfAPackageIsLookedUp) {
  const std::string directory = ros::package::getPath("roslib");
  ASSERT_FALSE(directory.empty());
  EXPECT_EQ(directory + "/meshes/a.stl", inputPath("package://roslib/meshes/a.stl"));
}

TEST(InputPath, IsRefusedWithAReason) {
  EXPECT_EQ("'file://elsewhere/a' names no file here; allowed: file:///PATH",
            reasonAgainst("file://elsewhere/a"));
  EXPECT_EQ("'file://a' names no file here; allowed: file:///PATH", reasonAgainst("file://a"));
  EXPECT_EQ(
      "'package://no_such_one/a': ROS knows no package 'no_such_one'; allowed: "
      "package://PACKAGE/PATH",
      reasonAgainst("package://no_such_one/a"));
  EXPECT_EQ("'package:///a': ROS knows no package ''; allowed: package://PACKAGE/PATH",
            reasonAgainst("package:///a"));
}

}  // namespace
}  // namespace spherical_springs::relax_mesh
