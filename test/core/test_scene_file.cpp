#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "scenes.h"
#include "spherical_springs/scene_file.h"
#include "spherical_springs/simulation.h"

namespace spherical_springs::core {
namespace {

namespace fs = std::filesystem;

class SceneFiles : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(directory_); }
  void TearDown() override { fs::remove_all(directory_); }

  std::string refusalOf(const std::string& text) {
    std::ofstream(path_) << text;
    try {
      readScene(path_, {});
    } catch (const std::invalid_argument& fault) {
      return fault.what();
    }
    return "not refused";
  }

  const fs::path directory_ =
      fs::temp_directory_path() / ("spherical_springs_" + std::to_string(::getpid()));
  const fs::path path_ = directory_ / "scene.json";
};

TEST_F(SceneFiles, ReadBackToTheLastBit) {
  Simulation simulation({});
  const Scene random = testing::randomScene(1, 30, 40, 0.1, 2);
  simulation.addParticles(random.particles().items());
  SpringLists springs;
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    const auto& items = random.springs<Spring>().items();
    springs.get<Spring>().assign(items.begin(), items.end());
  });
  simulation.addSprings(springs);
  simulation.removeParticles({3, 29});
  for (int i = 0; i < 1000; ++i) simulation.step();

  const Scene scene = simulation.presentScene();
  writeScene(path_, scene, simulation.state().time);
  const SceneFile file = readScene(path_, {});
  EXPECT_EQ(file.time, simulation.state().time);
  ASSERT_EQ(file.scene.particles().ids(), scene.particles().ids());
  for (std::size_t i = 0; i < scene.particles().size(); ++i) {
    const Particle& read = file.scene.particles().item(i);
    const Particle& written = scene.particles().item(i);
    EXPECT_EQ(read.position, written.position);
    EXPECT_EQ(read.angular_velocity, written.angular_velocity);
    EXPECT_EQ(read.mass, written.mass);
  }
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    const auto& read = file.scene.springs<Spring>();
    const auto& written = scene.springs<Spring>();
    ASSERT_EQ(read.ids(), written.ids());
    for (std::size_t i = 0; i < written.size(); ++i) {
      EXPECT_EQ(read.item(i).particles, written.item(i).particles);
      Spring::visitFields(written.item(i), [&](const char* name, double value, const Range&) {
        Spring::visitFields(read.item(i), [&](const char* other, double read_value, const Range&) {
          if (std::string(name) != other) return;
          EXPECT_EQ(read_value, value) << name;
        });
      });
    }
  });
  EXPECT_EQ(std::distance(fs::directory_iterator(directory_), {}), 1) << "nothing is left beside";
}

TEST_F(SceneFiles, MayLeaveFieldsOut) {
  std::ofstream(path_) << R"({"format": "spherical_springs scene 1",
    "particles": [{"position": [2, 0, 0]}, {"id": 5, "position": [0, 1, 0]}],
    "angle_springs": [{"particles": [0, 5], "stiffness": 2, "at_rest": true}]})";
  const SceneFile file = readScene(path_, {});
  EXPECT_EQ(file.time, 0);
  EXPECT_EQ(file.scene.particles().ids(), (std::vector<std::uint32_t>{0, 5}));
  EXPECT_DOUBLE_EQ(file.scene.springs<AngleSpring>().item(0).rest_angle, kPi / 2);
}

TEST_F(SceneFiles, AreRefusedWithThePlaceAndTheReason) {
  const std::string head = R"({"format": "spherical_springs scene 1", )";
  const std::vector<std::pair<std::string, std::string>> table = {
      {"", "parse error at line 1, column 1"},
      {head + R"("particles": [{"position": [1, 0, 0]})", "parse error at line 1, column 78"},
      {"[1, 2]", "the scene is not an object"},
      {R"({"particles": []})", "format is ''; allowed: spherical_springs scene 1"},
      {head + R"("particle": []})", "the scene has no field 'particle'"},
      {head + R"("time": -1})", "time is -1; allowed: 0 to 1e30 [s]"},
      {head + R"("particles": 3})", "the scene.particles is 3; allowed: a list"},
      {head + R"("particles": [3]})", "particles[0] is not an object"},
      {head + R"("particles": [{"position": [1, 0]}]})",
       "particles[0].position is [1,0]; allowed: 3 of them"},
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
       "particles[0].id is -1; allowed: an id"},
      {head + R"("particles": [{"position": [1e999, 0, 0]}]})", "number overflow parsing '1e999'"},
      {head + R"("angle_springs": [{"particles": [0, 1], "stiffness": 1}]})",
       "angle_springs[0].particles[0] is 0; allowed: the id of a particle"},
  };
  for (const auto& [text, reason] : table) {
    const std::string refusal = refusalOf(text);
    EXPECT_NE(refusal.find(reason), std::string::npos) << text << "\n" << refusal;
    EXPECT_EQ(refusal.find(path_.string() + " is not a scene: "), 0) << refusal;
  }
}

TEST_F(SceneFiles, ThatCannotBeReadOrWritten) {
  EXPECT_THROW(readScene(directory_ / "missing.json", {}), std::runtime_error);
  EXPECT_THROW(readScene(directory_, {}), std::runtime_error);
  EXPECT_THROW(writeScene(directory_ / "missing" / "scene.json", Scene(), 0), std::runtime_error);
  EXPECT_TRUE(fs::is_empty(directory_));
}

}  // namespace
}  // namespace spherical_springs::core
