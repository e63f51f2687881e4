// Memory that runs out at any allocation of a change leaves the scene as it was.
#include <gtest/gtest.h>

#include <cstddef>
#include <functional>
#include <new>
#include <sstream>

#include "scenes.h"
#include "spherical_springs/simulation.h"

namespace {

thread_local long allocations_left = -1;  // below zero: no bound

}  // namespace

extern "C" void* __libc_malloc(std::size_t size);

// The C library's own, but for one that fails when it is told to.
extern "C" void* malloc(std::size_t size) {
  if (allocations_left == 0) {
    allocations_left = -1;
    return nullptr;
  }
  if (allocations_left > 0) --allocations_left;
  return __libc_malloc(size);
}

namespace spherical_springs::core {
namespace {

SpringIds allIds(const Scene& scene) {
  SpringIds ids;
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    const auto& all = scene.springs<Spring>().ids();
    ids.get<Spring>().assign(all.begin(), all.end());
  });
  return ids;
}

class OutOfMemory : public ::testing::Test {
 protected:
  using Change = std::function<void(Simulation&)>;

  /// Everything that a scene is, to the last bit, and the next ids.
  std::string bitsOf(const Simulation& simulation) {
    std::ostringstream text;
    for (const Scene& scene : {simulation.scene(), simulation.presentScene()}) {
      writeScene(text, scene, simulation.state().time);
      text << scene.particles().nextId();
      forEachKind([&](auto kind) {
        text << ' ' << scene.springs<typename decltype(kind)::type>().nextId();
      });
    }
    text << simulation.state().steps << ' ' << simulation.state().positions.cols();
    return text.str();
  }

  /// Lets the first allocation of a change fail, then the second, until it succeeds.
  void expectAllOrNothing(const Change& change) {
    int failures = 0;
    for (bool succeeded = false; !succeeded; ++failures) {
      Simulation simulation({});
      simulation.addParticles(random_.particles().items());
      simulation.addSprings(testing::springsOf(random_));
      for (int i = 0; i < 5; ++i) simulation.step();
      const std::string before = bitsOf(simulation);
      try {
        allocations_left = failures;
        change(simulation);
        allocations_left = -1;
        succeeded = true;
        EXPECT_NE(bitsOf(simulation), before);
      } catch (const std::bad_alloc&) {
        ASSERT_EQ(bitsOf(simulation), before) << "at allocation " << failures;
        simulation.step();
      }
    }
    EXPECT_GT(failures, 1) << "nothing failed";
  }

  const Scene random_ = testing::randomScene(1, 10, 15, 0.1, 1);
};

TEST_F(OutOfMemory, WhileParticlesAreAdded) {
  expectAllOrNothing([this](Simulation& s) { s.addParticles(random_.particles().items()); });
}

TEST_F(OutOfMemory, WhileParticlesAreSet) {
  expectAllOrNothing([](Simulation& s) {
    s.setParticles({3, 5}, {testing::particleAt({1, 0, 0}), testing::particleAt({0, 1, 0})});
  });
}

TEST_F(OutOfMemory, WhileParticlesAreRemoved) {
  expectAllOrNothing([](Simulation& s) { s.removeParticles({2, 7}); });
}

TEST_F(OutOfMemory, WhileSpringsAreAdded) {
  expectAllOrNothing([this](Simulation& s) { s.addSprings(testing::springsOf(random_)); });
}

TEST_F(OutOfMemory, WhileSpringsAreSet) {
  SpringLists stiffer = testing::springsOf(random_);
  stiffer.get<AngleSpring>()[4].stiffness = 7;
  const SpringIds ids = allIds(random_);
  expectAllOrNothing([&](Simulation& s) { s.setSprings(ids, stiffer); });
}

TEST_F(OutOfMemory, WhileSpringsAreRemoved) {
  const SpringIds ids = allIds(random_);
  expectAllOrNothing([&](Simulation& s) { s.removeSprings(ids); });
}

TEST_F(OutOfMemory, WhileASceneIsReset) {
  expectAllOrNothing([](Simulation& s) { s.reset(); });
}

TEST_F(OutOfMemory, WhileASceneIsLoaded) {
  expectAllOrNothing([this](Simulation& s) { s.load({testing::randomScene(2, 20, 5), 3.}); });
}

TEST(Memory, OfASceneIsGivenBackWhenItIsCleared) {
  Scene scene = testing::randomScene(1, 10, 15, 0.1, 1);
  scene.clear();
  const auto expectNone = [](const auto& table) {
    EXPECT_EQ(0u, table.ids().capacity());
    EXPECT_EQ(0u, table.items().capacity());
  };
  expectNone(scene.particles());
  forEachKind([&](auto kind) { expectNone(scene.springs<typename decltype(kind)::type>()); });
}

}  // namespace
}  // namespace spherical_springs::core
