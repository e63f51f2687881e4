// Memory that runs out at any allocation of a call, or of a sample: the call is refused and has
// changed nothing, the sample is left out, and the next one works.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "node/conversion.h"
#include "node/faults.h"
#include "node/map_handler.h"
#include "node/markers.h"
#include "node/poses.h"
#include "short_memory.h"

namespace spherical_springs {
namespace {

using testing::ShortMemory;

std::vector<std::uint32_t> someIds() { return {2, 3, 5, 7}; }

std::vector<Particle> someParticles() {
  std::vector<Particle> particles(4);
  for (std::size_t i = 0; i < particles.size(); ++i) {
    particles[i].position.x = 1;
    particles[i].position.y = static_cast<double>(i);
  }
  return particles;
}

template <class Spring>
std::vector<Spring> someSprings() {
  Spring spring;
  for (std::size_t i = 0; i < spring.particles.size(); ++i) spring.particles[i] = i;
  spring.stiffness = 7;
  spring.at_rest = true;
  return {spring, spring};
}

template <class Request>
Request withSprings() {
  Request request;
  forEachKindInMessages(
      [&](auto kind) { kind.springs(request) = someSprings<typename decltype(kind)::Message>(); });
  request.oriented_angle_springs[0].width = request.oriented_angle_springs[1].width = 0.1;
  return request;
}

template <class Request>
Request withSpringIds(Request request) {
  forEachKindInMessages([&](auto kind) { kind.ids(request) = {0, 3}; });
  return request;
}

TEST_F(ShortMemoryTest, WhileParticlesAreAdded) {
  AddParticles::Request request;
  request.particles = someParticles();
  expectAllOrNothing<AddParticles>(&Handlers::addParticles, request);
}

TEST_F(ShortMemoryTest, WhileParticlesAreSet) {
  SetParticles::Request request;
  request.ids = someIds();
  request.particles = someParticles();
  expectAllOrNothing<SetParticles>(&Handlers::setParticles, request);
}

TEST_F(ShortMemoryTest, WhileParticlesAreRemoved) {
  RemoveParticles::Request request;
  request.ids = someIds();
  expectAllOrNothing<RemoveParticles>(&Handlers::removeParticles, request);
}

TEST_F(ShortMemoryTest, WhileSpringsAreAdded) {
  expectAllOrNothing<AddSprings>(&Handlers::addSprings, withSprings<AddSprings::Request>());
}

TEST_F(ShortMemoryTest, WhileSpringsAreSet) {
  expectAllOrNothing<SetSprings>(&Handlers::setSprings,
                                 withSpringIds(withSprings<SetSprings::Request>()));
}

TEST_F(ShortMemoryTest, WhileSpringsAreRemoved) {
  expectAllOrNothing<RemoveSprings>(&Handlers::removeSprings,
                                    withSpringIds(RemoveSprings::Request()));
}

TEST_F(ShortMemoryTest, WhileASceneIsRead) {
  expectAllOrNothing<GetScene>(&Handlers::getScene, {});
}

TEST_F(ShortMemoryTest, WhileASceneIsLoaded) {
  core::writeScene(directory_.path() / "other.json", core::testing::randomScene(2, 20, 5), 3);
  LoadScene::Request request;
  request.path = "other.json";
  expectAllOrNothing<LoadScene>(&Handlers::loadScene, request);
}

TEST_F(ShortMemoryTest, WhileASceneIsSaved) {
  const fs::path path = directory_.path() / "scene.json";
  const auto old = "what was there before";
  SaveScene::Request request;
  request.path = path.filename();
  for (const long failing : {1L, ShortMemory::kAll}) {
    bool succeeded = false;
    for (long failures = 0; !succeeded; ++failures) {
      std::ofstream(path, std::ios::trunc) << old;
      Node node(directory_.path());
      Client<SaveScene> client(node, &Handlers::saveScene, request);
      succeeded = client.callShortOfMemory(failures, failing).success;
      ASSERT_EQ(contentOf(path) == old, !succeeded) << failures << " of " << failing;
    }
  }
}

TEST_F(ShortMemoryTest, WhileASceneIsCleared) {
  expectAllOrNothing<std_srvs::Trigger>(&Handlers::clear, {});
}

TEST_F(ShortMemoryTest, WhileASceneIsReset) {
  expectAllOrNothing<std_srvs::Trigger>(&Handlers::reset, {});
}

TEST_F(ShortMemoryTest, WhileTimeIsLetGo) {
  std_srvs::SetBool::Request request;
  request.data = true;
  expectAllOrNothing<std_srvs::SetBool>(&Handlers::setRunning, request);
}

TEST_F(ShortMemoryTest, WhileItSteps) {
  Step::Request request;
  for (const unsigned steps : {0, 3}) {
    request.steps = steps;
    expectAllOrNothing<Step>(&Handlers::step, request);
  }
}

TEST_F(ShortMemoryTest, WhileItRelaxes) { expectAllOrNothing<Relax>(&Handlers::relax, {}); }

TEST_F(ShortMemoryTest, WhileItRelaxesAndDoesNotConverge) {
  Relax::Request request;
  request.tolerance = 1e-300;
  expectAllOrNothing<Relax>(&Handlers::relax, request);
}

class Unfollowed : public MapFollower {
 public:
  bool goesOn(const mesh::MapProgress&) noexcept override { return true; }
  void cancelled() noexcept override {}
};

// Where memory runs out only when there is a map, that is loaded.
TEST_F(ShortMemoryTest, WhileAMeshIsMapped) {
  MapMeshGoal goal = testing::tetrahedronGoal();
  goal.load = true;
  int refusals = 0;
  for (const long failing : {1L, ShortMemory::kAll}) {
    bool succeeded = false;
    for (long failures = 0; !succeeded; failures += 1 + failures / 8) {
      Node node(directory_.path());
      MapHandler handler(node.runner, node.news, node.mappings, {}, 1);
      const std::string before = node.bits();
      Unfollowed follower;
      MapMeshResult result;
      try {
        const ShortMemory memory(failures, failing);
        handler.map(goal, result, follower);
        succeeded = result.message.find("memory") == std::string::npos;
      } catch (const std::exception& fault) {
        ++refusals;
        ASSERT_STREQ(reasonOf(fault), "there is not enough memory for this");
        ASSERT_EQ(node.bits(), before) << failures;
      }
    }
  }
  EXPECT_GT(refusals, 10);
}

TEST_F(ShortMemoryTest, WhileNothingIsCancelled) {
  expectAllOrNothing<std_srvs::Trigger>(&Handlers::cancel, {});
}

TEST_F(ShortMemoryTest, WhileARequestIsRefused) {
  Node node(directory_.path());
  SetParticles::Request request;
  request.ids = someIds();
  Client<SetParticles> client(node, &Handlers::setParticles, request);
  const std::string reason = client.call().message;
  long failures = 0;
  while (client.callShortOfMemory(failures, ShortMemory::kAll).message != reason) ++failures;
  EXPECT_GT(failures, 1);
}

/// Lets the first allocation of `make` and all after it fail, then the second, until it succeeds.
template <class Make>
void expectBadAllocUntilItWorks(const Make& make) {
  long failures = 0;
  for (bool made = false; !made; ++failures) {
    const ShortMemory memory(failures, ShortMemory::kAll);
    made = runLoggingFaults("a sample is left out", make);
  }
  EXPECT_GT(failures, 1) << "nothing failed";
}

TEST_F(ShortMemoryTest, LeavesSamplesOut) {
  Node node(directory_.path());
  expectBadAllocUntilItWorks([&] {
    const auto now = node.runner.snapshot();
    particlesMarker(*now.plan->system(), now.state.positions, 1);
    arcsMarker(*now.plan->system(), now.state.positions, 1);
    trianglesMarker(*now.plan->system(), now.state.positions, 1);
  });
  expectBadAllocUntilItWorks([&] {
    const auto now = node.runner.snapshot();
    ros::serialization::serializeMessage(Poses{{}, now.state.positions, 1});
  });
  expectBadAllocUntilItWorks([&] { energiesOf(node.runner.snapshot(), "a name of some length"); });
}

TEST(News, TakesNoMemory) {
  const std::string text(2 * News::kLongest, 'x');
  News news;
  {
    const ShortMemory memory(0, ShortMemory::kAll);
    news.tell(text, "relax: ");
    news.refused(text);
    news.relaxed(text);
    news.statusChanged();
  }
  const News::Facts facts = news.facts();
  EXPECT_EQ(facts.message, ("relax: " + text).substr(0, facts.message.size()));
  for (const std::string& told : {facts.message, facts.refusal, facts.relaxation_fault}) {
    EXPECT_GE(told.size(), News::kLongest);
    EXPECT_LT(told.size(), text.size());
  }
}

}  // namespace
}  // namespace spherical_springs
