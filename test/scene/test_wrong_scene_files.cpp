// Files that are no scenes, and what is said of them.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "spherical_springs/scene_file.h"
#include "support/scenes.h"

namespace spherical_springs::core {
namespace {

namespace fs = std::filesystem;

class WrongSceneFiles : public ::testing::Test {
 protected:
  void TearDown() override { fs::remove(path_); }

  std::string refusalOf(const std::string& text) {
    std::ofstream(path_) << text;
    try {
      readScene(path_, {});
    } catch (const std::invalid_argument& fault) {
      return fault.what();
    }
    return "not refused";
  }

  const fs::path path_ = fs::temp_directory_path() /
                         ("spherical_springs_wrong_" + std::to_string(::getpid()) + ".json");
};

TEST_F(WrongSceneFiles, AreRefusedWithThePlaceAndTheReason) {
  const std::string head = R"({"format": "spherical_springs scene 1", )";
  const std::vector<std::pair<std::string, std::string>> table = {
      {"", "at byte 1: the text ends before the scene does"},
      {head + R"("particles": [{"position": [1, 0, 0]})",
       "at byte 78: the text ends before the scene does"},
      {head + R"("time)", "the text ends before the scene does"},
      {"\xff\n", "at byte 1: this is not JSON: '?'"},
      {head + R"("particles": [{"mass": NaN}]})", R"(this is not JSON: '"mass": N')"},
      {"[1, 2]", "the scene is not an object"},
      {R"({"particles": []})", "format is ''; allowed: spherical_springs scene 1"},
      {head + R"("particle": []})", "the scene has no field 'particle'"},
      {head + R"("time": -1})", "time is -1; allowed: 0 to 1e300 [s]"},
      {head + R"("particles": 3})", "the scene.particles is 3; allowed: a list"},
      {head + R"("particles": [3]})", "particles[0] is not an object"},
      {head + R"("particles": [{"position": [1, 0]}]})",
       "particles[0].position is [1,0]; allowed: a list of 3"},
      {head + R"("particles": [{"position": [1, 0, "x"]}]})",
       "particles[0].position is [1,0,\"x\"]; allowed: three numbers"},
      {head + R"("particles": [{"position": [0, 0, 0]}]})",
       "particles[0].position is (0, 0, 0); allowed: any finite non-zero vector"},
      {head + R"("particles": [{"position": [1, 0, 0], "weight": 1}]})",
       "particles[0] has no field 'weight'"},
      {head +
           R"("particles": [{"id": 3, "position": [1, 0, 0]}, {"id": 3, "position": [1, 0, 0]}]})",
       "particles[1].id is 3; allowed: 4 to 4294967294, rising"},
      {head + R"("particles": [{"id": -1, "position": [1, 0, 0]}]})",
       "particles[0].id is -1; allowed: whole numbers from 0 to 4294967294"},
      {head + R"("particles": [{"id": 0.5, "position": [1, 0, 0]}]})",
       "particles[0].id is 0.5; allowed: whole numbers from 0 to 4294967294"},
      {head + R"("particles": [{"id": 4294967295, "position": [1, 0, 0]}]})",
       "particles[0].id is 4294967295; allowed: whole numbers from 0 to 4294967294"},
      {head + R"("particles": [{"id": [3], "position": [1, 0, 0]}]})",
       "particles[0].id is [3]; allowed: whole numbers from 0 to 4294967294"},
      {head + R"("angle_springs": [{"particles": [0, 1e300]}]})",
       "angle_springs[0].particles[1] is 1e+300; allowed: whole numbers from 0 to 4294967294"},
      {head + R"("particles": [{"position": [1e999, 0, 0]}]})", "the number 1e999 is too large"},
      {head + R"("angle_springs": [{"particles": [0, 1], "stiffness": 1}]})",
       "angle_springs[0].particles[0] is 0; allowed: the id of a particle"},
      {head + R"("particles": [], "particles": []})", "the scene has two fields 'particles'"},
      {head + R"("particles": {"position": [1, 0, 0]}})", "the scene.particles is an object"},
      {head + R"("time": [3]})", "the scene has no field 'time' that holds others"},
      {head + R"("particles": [[1, 0, 0]]})", "particles[0] is not an object"},
      {head + R"("particles": [{"position": [[1], 0, 0]}]})",
       "particles[0].position has a list or an object inside; allowed: values"},
      {head + R"("particles": [{"position": [{}, 0, 0]}]})",
       "particles[0].position has a list or an object inside; allowed: values"},
      {head + R"("particles": []} {})", "at byte 58: there is more after the end of the scene"},
      {R"({"format": ")" + std::string(1000, 'x') + "\"}",
       "format is '" + std::string(100, 'x') + "...' (1000 bytes); allowed: "},
  };
  for (const auto& [text, reason] : table) {
    const std::string refusal = refusalOf(text);
    EXPECT_NE(refusal.find(reason), std::string::npos) << text << "\n" << refusal;
    EXPECT_EQ(refusal.find(path_.string() + " is not a scene: "), 0) << refusal;
    EXPECT_EQ(refusal.find("json"), refusal.rfind("json")) << "but in the name: " << refusal;
  }
}

TEST_F(WrongSceneFiles, AreRefusedWhereAFieldIsGivenTwice) {
  const std::string head = R"({"format": "spherical_springs scene 1", )";
  const auto inItem = [&](const std::string& list, const std::string& item) {
    return head + '"' + list + R"(": [)" + item + "]}";
  };
  const std::vector<std::pair<std::string, std::string>> table = {
      {inItem("particles", R"({"position": [1, 0, 0], "mass": 1, "mass": 5})"),
       "particles[0] has two fields 'mass'"},
      {inItem("particles", R"({"position": [1, 0, 0], "mass": 1, "mass": 1})"),
       "particles[0] has two fields 'mass'"},
      {inItem("particles", R"({"position": [1, 0, 0], "mass": 1, "mass": 5})"),
       "particles[0] has two fields 'mass'"},
      {inItem("particles", R"({"position": [1, 0, 0], "position": [0, 1, 0]})"),
       "particles[0] has two fields 'position'"},
      {inItem("particles", R"({"position": [1, 0, 0]}, {"id": 1, "pinned": true, "id": 2)"),
       "particles[1] has two fields 'id'"},
      {inItem("angle_springs", R"({"particles": [0, 1], "rest_angle": 1, "rest_angle": 2})"),
       "angle_springs[0] has two fields 'rest_angle'"},
      {inItem("solid_angle_springs", R"({"particles": [0, 1, 2], "particles": [0, 1, 2]})"),
       "solid_angle_springs[0] has two fields 'particles'"},
      {inItem("oriented_angle_springs", R"({"width": 1, "at_rest": true, "at_rest": false})"),
       "oriented_angle_springs[0] has two fields 'at_rest'"},
      {head + R"("format": "spherical_springs scene 1"})", "the scene has two fields 'format'"},
      {head + R"("time": 1, "time": 2})", "the scene has two fields 'time'"},
      {head + R"("angle_springs": [], "particles": [], "angle_springs": []})",
       "the scene has two fields 'angle_springs'"},
  };
  for (const auto& [text, reason] : table) {
    EXPECT_NE(refusalOf(text).find(reason), std::string::npos) << text << "\n" << refusalOf(text);
  }
  EXPECT_EQ(refusalOf(inItem("particles", R"({"position": [1, 0, 0], "mass": 1},
                                             {"position": [1, 0, 0], "mass": 5})")),
            "not refused");
}

TEST_F(WrongSceneFiles, AreRefusedAtTheFirstFieldThatIsTooMuch) {
  std::string fields;
  for (int i = 0; i < 100000; ++i) fields += "\"" + std::to_string(i) + "\": 1, ";
  const std::string head = R"({"format": "spherical_springs scene 1", )";
  EXPECT_NE(refusalOf(head + R"("particles": [{)" + fields).find("has more than 32 fields"),
            std::string::npos);
  EXPECT_NE(refusalOf(head + fields).find("the scene has more than 32 fields"), std::string::npos);
}

TEST_F(WrongSceneFiles, AreRefusedWithTheByte) {
  const std::string head = R"({"format": "spherical_springs scene 1", "particles": [
    {"position": [1, 0, 0]}, )";
  const std::string bad_values[] = {
      R"({"position": [0, 0, 0]})", R"({"position": [1, 0, 0], "weight": 1})",
      R"({"id": 0, "position": [1, 0, 0]})", R"({"position": [1, 0, 0], "mass": -1})"};
  for (const std::string& bad : bad_values) {
    const std::string refusal = refusalOf(head + bad + R"(, {"position": [1, 0, 0]}]})");
    EXPECT_NE(
        refusal.find("before byte " + std::to_string(head.size() + bad.size()) + ": particles[1]"),
        std::string::npos)
        << bad << "\n"
        << refusal;
  }
  const std::string refusal = refusalOf(head);
  EXPECT_NE(refusal.find("at byte " + std::to_string(head.size() + 1) + ": "), std::string::npos)
      << refusal;
}

TEST_F(WrongSceneFiles, WithAByteOfZeroAfterTheEndAreRefused) {
  const std::string scene = R"({"format": "spherical_springs scene 1"})";
  const std::string zero(1, '\0');
  EXPECT_EQ(refusalOf(scene + "\n"), "not refused");
  for (const std::string& more : {zero, zero + "}garbage", "\n" + zero + "\n"}) {
    const std::size_t byte = scene.size() + more.find('\0') + 1;
    EXPECT_NE(
        refusalOf(scene + more)
            .find("at byte " + std::to_string(byte) + ": there is more after the end of the scene"),
        std::string::npos);
  }
}

TEST_F(WrongSceneFiles, TruncatedAnywhereAreRefused) {
  writeScene(path_, testing::randomScene(1, 4, 2), 1);
  std::stringstream text;
  text << std::ifstream(path_).rdbuf();
  const std::string whole = text.str().substr(0, text.str().rfind('}') + 1);
  for (std::size_t length = 0; length < whole.size(); ++length) {
    EXPECT_NE(refusalOf(whole.substr(0, length)).find("at byte "), std::string::npos) << length;
  }
  EXPECT_EQ(refusalOf(whole), "not refused");
}

TEST_F(WrongSceneFiles, AreRefusedAtTheFirstItemTooMany) {
  // Neither file goes on after that item: nothing that follows has been read.
  const std::string head = R"({"format": "spherical_springs scene 1", "particles": [{"position")";
  SceneLimits limits;
  limits.particles = 1;
  std::istringstream particles(head + R"(: [1, 0, 0]}, {"position": [1, 0, 0]}, nonsense)");
  limits.springs = 1;
  std::istringstream springs(
      head + R"(: [1, 0, 0]}], "angle_springs": [{}], "solid_angle_springs")" + ": [{}, nonsense");
  for (const auto& [file, reason] :
       {std::pair<std::istream*, std::string>{&particles, "particles in the file are 2 or more"},
        {&springs, "springs in the file are 2 or more"}}) {
    try {
      readScene(*file, limits);
      ADD_FAILURE() << "not refused: " << reason;
    } catch (const std::invalid_argument& fault) {
      EXPECT_NE(std::string(fault.what()).find(reason), std::string::npos) << fault.what();
    }
  }
}

}  // namespace
}  // namespace spherical_springs::core
