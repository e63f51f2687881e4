// Scene files with ids near the largest.
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "spherical_springs/scene_file.h"
#include "spherical_springs/simulation.h"
#include "support/scenes.h"

namespace spherical_springs::core {
namespace {

/// A scene of three particles and a spring of each kind, one item of which has an id of its own.
std::string sceneWithId(const std::string& list, const std::string& id) {
  const auto item = [&](const std::string& of, const std::string& fields) {
    return "{" + (of == list ? "\"id\": " + id + ", " : "") + fields + "}";
  };
  std::string text = R"({"format": "spherical_springs scene 1", "particles": [
      {"id": 0, "position": [1, 0, 0]}, {"id": 1, "position": [0, 1, 0]},
      {"id": 2, "position": [0, 0, 1]}, )" +
                     item("particles", R"("position": [0, 0, -1])") + "]";
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    const std::string ends = Spring::kParticles == 2 ? "[0, 1]" : "[0, 1, 2]";
    text +=
        std::string(", \"") + Spring::kTable + "\": [" +
        item(Spring::kTable, "\"particles\": " + ends + R"(, "stiffness": 1, "at_rest": true)") +
        "]";
  });
  return text + "}";
}

class SceneFilesOfLargeIds : public ::testing::Test {
 protected:
  static std::string refusalToLoad(Simulation& simulation, const std::string& text) {
    try {
      std::istringstream in(text);
      simulation.load(readScene(in, {}));
    } catch (const std::invalid_argument& fault) {
      return fault.what();
    }
    return "loaded";
  }

  static void expectRoomForMore(Simulation& simulation) {
    const auto ids =
        simulation.addParticles({testing::particleAt({1, 0, 0}), testing::particleAt({0, 1, 0}),
                                 testing::particleAt({0, 0, 1})});
    SpringLists springs;
    forEachKind([&](auto kind) {
      using Spring = typename decltype(kind)::type;
      Spring spring;
      std::copy_n(ids.begin(), Spring::kParticles, spring.particles.begin());
      spring.stiffness = 1;
      spring.at_rest = true;
      springs.get<Spring>().push_back(spring);
    });
    simulation.addSprings(springs);
  }

  static std::vector<std::string> lists() {
    std::vector<std::string> names = {"particles"};
    forEachKind([&](auto kind) { names.emplace_back(decltype(kind)::type::kTable); });
    return names;
  }
};

TEST_F(SceneFilesOfLargeIds, LeaveIdsForWhatIsAddedLater) {
  for (const std::string& list : lists()) {
    Simulation simulation({});
    ASSERT_EQ(refusalToLoad(simulation, sceneWithId(list, "4000000000")), "loaded");
    expectRoomForMore(simulation);
  }
}

TEST_F(SceneFilesOfLargeIds, AreRefusedWhereTheyWouldUseUpAllIds) {
  for (const std::string& list : lists()) {
    for (const std::string id : {"4000000001", "4294967294"}) {
      Simulation simulation({});
      simulation.addParticles({testing::particleAt({1, 0, 0})});
      const std::string item = list + (list == "particles" ? "[3]" : "[0]");
      EXPECT_EQ(refusalToLoad(simulation, sceneWithId(list, id)),
                item + ".id is " + id +
                    "; allowed: at most 4000000000, so that there are ids for what is added later");
      EXPECT_EQ(simulation.scene().particles().ids(), std::vector<std::uint32_t>{0});
      expectRoomForMore(simulation);
      simulation.clear();
      expectRoomForMore(simulation);
    }
  }
}

TEST_F(SceneFilesOfLargeIds, AreReadBackWhereTheyWereGiven) {
  for (const std::string& list : lists()) {
    Simulation simulation({});
    ASSERT_EQ(refusalToLoad(simulation, sceneWithId(list, "4000000000")), "loaded");
    expectRoomForMore(simulation);
    std::ostringstream text;
    writeScene(text, simulation.presentScene(), 0);
    EXPECT_EQ(refusalToLoad(simulation, text.str()), "loaded");
    expectRoomForMore(simulation);
  }
}

TEST_F(SceneFilesOfLargeIds, AreRefusedWhereAnIdLeftOutWouldFollowTheLargest) {
  Simulation simulation({});
  EXPECT_NE(refusalToLoad(simulation, R"({"format": "spherical_springs scene 1", "particles": [
                {"id": 4294967294, "position": [1, 0, 0]}, {"position": [0, 1, 0]}]})")
                .find("particles[1].id cannot follow 4294967294, the largest there is"),
            std::string::npos);
}

}  // namespace
}  // namespace spherical_springs::core
