// Which files a service may name.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "node/scene_directory.h"

namespace spherical_springs {
namespace {

namespace fs = std::filesystem;

class SceneDirectories : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(scenes_ / "folder");
    fs::create_directory(outside_);
  }
  void TearDown() override { fs::remove_all(root_); }

  /// The path of a name relative to the directory, or why it is refused.
  std::string pathOf(const std::string& name) const {
    try {
      return SceneDirectory(scenes_.string()).inside(name).lexically_relative(scenes_).string();
    } catch (const std::invalid_argument& fault) {
      return fault.what();
    }
  }

  const fs::path root_ = fs::canonical(fs::temp_directory_path()) /
                         ("spherical_springs_directories_" + std::to_string(::getpid()));
  const fs::path scenes_ = root_ / "scenes", outside_ = root_ / "outside";
};

TEST_F(SceneDirectories, TakeLinksThatStayInside) {
  std::ofstream(scenes_ / "there.json") << "{}";
  fs::create_symlink("../there.json", scenes_ / "folder" / "to_file");
  fs::create_symlink("folder/new.json", scenes_ / "to_new_file");
  fs::create_symlink(scenes_ / "to_new_file", scenes_ / "to_link");
  fs::create_directory_symlink("folder", scenes_ / "to_folder");
  fs::create_symlink("../outside/../scenes/new.json", scenes_ / "there_and_back");
  EXPECT_EQ(pathOf("folder/to_file"), "there.json");
  EXPECT_EQ(pathOf("to_new_file"), "folder/new.json");
  EXPECT_EQ(pathOf("to_link"), "folder/new.json");
  EXPECT_EQ(pathOf("to_folder/new.json"), "folder/new.json");
  EXPECT_EQ(pathOf("to_folder/../new.json"), "new.json");
  EXPECT_EQ(pathOf("there_and_back"), "new.json");
}

TEST_F(SceneDirectories, RefuseLinksThatLeadOutside) {
  std::ofstream(outside_ / "there.json") << "{}";
  fs::create_symlink("../outside/there.json", scenes_ / "to_file");
  fs::create_symlink("../outside/new.json", scenes_ / "to_new_file");
  fs::create_symlink(outside_ / "new.json", scenes_ / "to_new_file_by_its_whole_path");
  fs::create_symlink("to_new_file", scenes_ / "to_link");
  fs::create_directory_symlink("../outside", scenes_ / "to_folder");
  fs::create_symlink("to_folder/new.json", scenes_ / "by_way_of_a_folder");
  for (const char* name :
       {"to_file", "to_new_file", "to_new_file_by_its_whole_path", "to_link", "by_way_of_a_folder",
        "to_folder/there.json", "to_folder/new.json", "../outside/new.json"}) {
    EXPECT_EQ(pathOf(name),
              "path is '" + std::string(name) + "'; allowed: files inside " + scenes_.string());
  }
}

TEST_F(SceneDirectories, RefuseLinksThatGoRoundInCircles) {
  fs::create_symlink("other", scenes_ / "one");
  fs::create_symlink("one", scenes_ / "other");
  EXPECT_EQ(pathOf("one"),
            "path is 'one'; allowed: the name of a file; Too many levels of symbolic links");
}

TEST_F(SceneDirectories, AreMadeWhereALinkLeads) {
  fs::create_directory_symlink("outside/new", root_ / "link");
  const SceneDirectory directory((root_ / "link").string());
  directory.make();
  EXPECT_TRUE(fs::is_directory(outside_ / "new"));
  EXPECT_EQ(directory.inside("a.json"), outside_ / "new" / "a.json");
}

}  // namespace
}  // namespace spherical_springs
