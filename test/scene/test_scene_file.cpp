#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>

#include "spherical_springs/scene_file.h"
#include "spherical_springs/simulation.h"
#include "support/scenes.h"

namespace spherical_springs::core {
namespace {

namespace fs = std::filesystem;

class SceneFiles : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(directory_); }
  void TearDown() override { fs::remove_all(directory_); }

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

TEST_F(SceneFiles, AreTakenAgainHoweverFastAndLateTheirScenesAre) {
  Particle particle = testing::particleAt({0.3, 0.2, 1});
  particle.angular_velocity = 1e100 * Vector3(1, -1, 1).normalized();
  Scene scene;
  scene.addParticles({particle});
  writeScene(path_, scene, 1.0000000000000004e30);
  const SceneFile file = readScene(path_, {});
  EXPECT_EQ(file.time, 1.0000000000000004e30);
  EXPECT_EQ(file.scene.particles().item(0).angular_velocity,
            scene.particles().item(0).angular_velocity);
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
