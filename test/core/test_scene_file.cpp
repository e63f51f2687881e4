#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>

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
  simulation.addSprings(testing::springsOf(random));
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

TEST_F(SceneFiles, ReadBackNumbersOfEveryForm) {
  const double numbers[] = {-0., 1, 1e30, 1e-300, 5e-324, 0.1, 123456789, 1. / 3, 1e22, -2.5e-7};
  for (const double number : numbers) {
    Particle particle = testing::particleAt(Vector3(1, 0, 0));
    particle.angular_velocity = Vector3(0, number, 0);
    Scene scene;
    scene.addParticles({particle});
    writeScene(path_, scene, 0);
    const double read = readScene(path_, {}).scene.particles().item(0).angular_velocity.y();
    EXPECT_EQ(read, number);
    EXPECT_EQ(std::signbit(read), std::signbit(number)) << number;
  }
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

TEST_F(SceneFiles, MayHaveWholeNumbersWrittenAsReals) {
  std::ofstream(path_) << R"({"format": "spherical_springs scene 1",
    "particles": [{"id": 2.0, "position": [1, 0, 0]}, {"id": 3e1, "position": [0, 1, 0]}],
    "angle_springs": [{"id": 1.0, "particles": [2.0, 30.0], "stiffness": 2, "at_rest": true}]})";
  const Scene scene = readScene(path_, {}).scene;
  EXPECT_EQ(scene.particles().ids(), (std::vector<std::uint32_t>{2, 30}));
  EXPECT_EQ(scene.springs<AngleSpring>().ids(), std::vector<std::uint32_t>{1});
  EXPECT_EQ(scene.springs<AngleSpring>().item(0).particles, (std::array<std::uint32_t, 2>{2, 30}));
}

TEST_F(SceneFiles, AreRefusedWithThePlaceAndTheReason) {
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
      {head + R"("time": -1})", "time is -1; allowed: 0 to 1e30 [s]"},
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
       "angle_springs[0].particles is 1e+300; allowed: whole numbers from 0 to 4294967294"},
      {head + R"("particles": [{"position": [1e999, 0, 0]}]})", "the number 1e999 is too large"},
      {head + R"("angle_springs": [{"particles": [0, 1], "stiffness": 1}]})",
       "angle_springs[0].particles[0] is 0; allowed: the id of a particle"},
      {head + R"("particles": [], "particles": []})", "the scene has two fields 'particles'"},
      {head + R"("particles": {"position": [1, 0, 0]}})", "the scene.particles is an object"},
      {head + R"("time": [3]})", "the scene has no field 'time' that holds others"},
      {head + R"("particles": [[1, 0, 0]]})", "particles[0] is not an object"},
      {head + R"("particles": [{"position": [[1], 0, 0]}]})", "lists in lists"},
      {head + R"("particles": [{"position": [{}, 0, 0]}]})", "lists in lists"},
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

TEST_F(SceneFiles, AreRefusedWhereAFieldIsGivenTwice) {
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

TEST_F(SceneFiles, AreRefusedAtTheFirstFieldThatIsTooMuch) {
  std::string fields;
  for (int i = 0; i < 100000; ++i) fields += "\"" + std::to_string(i) + "\": 1, ";
  const std::string head = R"({"format": "spherical_springs scene 1", )";
  EXPECT_NE(refusalOf(head + R"("particles": [{)" + fields).find("has more than 32 fields"),
            std::string::npos);
  EXPECT_NE(refusalOf(head + fields).find("the scene has more than 32 fields"), std::string::npos);
}

TEST_F(SceneFiles, AreRefusedWithTheByte) {
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

TEST_F(SceneFiles, TruncatedAnywhereAreRefused) {
  writeScene(path_, testing::randomScene(1, 4, 2), 1);
  std::stringstream text;
  text << std::ifstream(path_).rdbuf();
  const std::string whole = text.str().substr(0, text.str().rfind('}') + 1);
  for (std::size_t length = 0; length < whole.size(); ++length) {
    EXPECT_NE(refusalOf(whole.substr(0, length)).find("at byte "), std::string::npos) << length;
  }
  EXPECT_EQ(refusalOf(whole), "not refused");
}

TEST_F(SceneFiles, AreRefusedAtTheFirstItemTooMany) {
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

TEST_F(SceneFiles, WrittenByManyAtOnceAreWhole) {
  const Scene small = testing::randomScene(1, 3, 1), large = testing::randomScene(2, 300, 100);
  std::vector<std::thread> writers;
  for (int i = 0; i < 4; ++i) {
    writers.emplace_back([&, i] {
      for (int j = 0; j < 10; ++j) writeScene(path_, i % 2 ? small : large, 0);
    });
  }
  for (int i = 0; i < 50; ++i) {
    if (!fs::exists(path_)) continue;
    const std::size_t particles = readScene(path_, {}).scene.particles().size();
    EXPECT_TRUE(particles == 3 || particles == 300) << particles;
  }
  for (std::thread& writer : writers) writer.join();
  readScene(path_, {});
  EXPECT_EQ(std::distance(fs::directory_iterator(directory_), {}), 1) << "nothing is left beside";
}

TEST_F(SceneFiles, ThatCannotBeReadOrWritten) {
  const auto fault_of = [](const fs::path& path) -> std::string {
    try {
      readScene(path, {});
    } catch (const std::runtime_error& fault) {
      return fault.what();
    }
    return "none";
  };
  const fs::path missing = directory_ / "missing.json";
  EXPECT_EQ(fault_of(missing), "cannot read " + missing.string() + ": No such file or directory");
  EXPECT_EQ(fault_of(directory_), "cannot read " + directory_.string() + ": not a file");
  const fs::path nowhere = directory_ / "missing" / "scene.json";
  const fs::path too_long = directory_ / std::string(256, 'x');
  EXPECT_EQ(fault_of(too_long), "cannot read " + too_long.string() + ": File name too long");
  for (const auto& [path, reason] :
       {std::pair{nowhere, "No such file or directory"}, {too_long, "File name too long"}}) {
    try {
      writeScene(path, Scene(), 0);
      ADD_FAILURE() << "no fault: " << path;
    } catch (const std::runtime_error& fault) {
      EXPECT_EQ(fault.what(), "cannot write " + path.string() + ": " + reason);
    }
  }
  EXPECT_TRUE(fs::is_empty(directory_));
}

TEST_F(SceneFiles, AreNamedOnOneLine) {
  const auto fault_of = [](const auto& use) -> std::string {
    try {
      use();
    } catch (const std::exception& fault) {
      return fault.what();
    }
    return "none";
  };
  const std::string shown = (directory_ / "a?b?").string();
  const fs::path path = directory_ / "a\nb\x1b", nowhere = path / "c";
  EXPECT_EQ(fault_of([&] { readScene(path, {}); }),
            "cannot read " + shown + ": No such file or directory");
  EXPECT_EQ(fault_of([&] { writeScene(nowhere, Scene(), 0); }),
            "cannot write " + shown + "/c: No such file or directory");
  std::ofstream(path) << "1";
  EXPECT_EQ(fault_of([&] { readScene(path, {}); }).find(shown + " is not a scene: "), 0u);
  EXPECT_EQ(fault_of([&] { readScene(nowhere, {}); }),
            "cannot read " + shown + "/c: Not a directory");
  const std::string too_long = path.string() + std::string(255, 'x');
  EXPECT_EQ(fault_of([&] { readScene(too_long, {}); }),
            "cannot read " + shown + std::string(255, 'x') + ": File name too long");
  fs::remove(path);
  fs::create_directory(path);
  EXPECT_EQ(fault_of([&] { readScene(path, {}); }), "cannot read " + shown + ": not a file");
  EXPECT_EQ(fault_of([&] { writeScene(path, Scene(), 0); }),
            "cannot write " + shown + ": not a file");
}

TEST_F(SceneFiles, TakeTheirPlaceOfFilesAlone) {
  const fs::path pipe = directory_ / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THROW(writeScene(pipe, Scene(), 0), std::runtime_error);
  EXPECT_TRUE(fs::is_fifo(pipe));
}

}  // namespace
}  // namespace spherical_springs::core
