// Memory that runs out at any allocation of a call, or of a sample: the call is refused and has
// changed nothing, the sample is left out, and the next one works.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

#include "failing_malloc.h"
#include "node/answering_service.h"
#include "node/conversion.h"
#include "node/faults.h"
#include "node/handlers.h"
#include "node/markers.h"
#include "node/poses.h"
#include "support/scenes.h"

namespace spherical_springs {
namespace {

using testing::ShortMemory;

namespace fs = std::filesystem;

class TemporaryDirectory {
 public:
  TemporaryDirectory()
      : path_(fs::temp_directory_path() / ("short_memory_" + std::to_string(::getpid()))) {
    fs::create_directory(path_);
  }
  ~TemporaryDirectory() { fs::remove_all(path_); }
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;

  const fs::path& path() const { return path_; }

 private:
  const fs::path path_;
};

std::string contentOf(const fs::path& path) {
  std::ostringstream content;
  content << std::ifstream(path).rdbuf();
  return content.str();
}

/// All of a node but what it needs a network for, with a scene that has moved.
struct Node {
  explicit Node(const fs::path& directory)
      : directory(directory), handlers(runner, news, this->directory, {}, "map") {
    const core::Scene random = core::testing::randomScene(1, 10, 15, 0.1, 1);
    runner.change([&](core::Simulation& s) {
      s.addParticles(random.particles().items());
      s.addSprings(core::testing::springsOf(random));
    });
    runner.step(5);
  }

  /// Everything that a scene is, to the last bit, and the next ids.
  std::string bits() {
    std::ostringstream text;
    runner.read([&](const core::Simulation& s) {
      for (const core::Scene& scene : {s.scene(), s.presentScene()}) {
        core::writeScene(text, scene, s.state().time);
        text << scene.particles().nextId();
        core::forEachKind([&](auto kind) {
          text << ' ' << scene.springs<typename decltype(kind)::type>().nextId();
        });
      }
      text << ' ' << s.state().steps;
    });
    text << ' ' << runner.snapshot().running;
    return text.str();
  }

  core::Runner runner{{}, false};
  News news;
  SceneDirectory directory;
  Handlers handlers;
};

template <class Service>
using Handler = void (Handlers::*)(const typename Service::Request&, Answer<Service>&);

/// A service as a client finds it.
template <class Service>
class Client {
 public:
  Client(Node& node, Handler<Service> handle, const typename Service::Request& request)
      : refusals_("a service", node.news),
        service_(
            {},
            [&node, handle](const auto& request, auto& answer) {
              (node.handlers.*handle)(request, answer);
            },
            refusals_),
        request_(bytesOf(request)) {}

  typename Service::Response call() {
    ros::ServiceCallbackHelperCallParams params;
    params.request = request_;
    return responseIn(callWith(params));
  }

  typename Service::Response callShortOfMemory(long succeeding, long failing) {
    ros::ServiceCallbackHelperCallParams params;
    params.request = request_;
    {
      const ShortMemory memory(succeeding, failing);
      callWith(params);
    }
    return responseIn(params);
  }

 private:
  // As it comes to a service, without the length before it.
  static ros::SerializedMessage bytesOf(const typename Service::Request& request) {
    const auto whole = ros::serialization::serializeMessage(request);
    ros::SerializedMessage bytes(whole.buf, whole.num_bytes);
    bytes.message_start = whole.message_start;
    return bytes;
  }

  ros::ServiceCallbackHelperCallParams& callWith(ros::ServiceCallbackHelperCallParams& params) {
    service_.call(params);
    return params;
  }

  static typename Service::Response responseIn(const ros::ServiceCallbackHelperCallParams& params) {
    constexpr std::uint32_t kHeader = 5;  // a flag and the length
    const ros::SerializedMessage& bytes = params.response;
    ros::serialization::IStream stream(bytes.buf.get() + kHeader,
                                       static_cast<std::uint32_t>(bytes.num_bytes) - kHeader);
    typename Service::Response response;
    stream.next(response);
    EXPECT_EQ(stream.getLength(), 0u);
    return response;
  }

  Refusals refusals_;
  AnsweringService<Service> service_;
  const ros::SerializedMessage request_;
};

class ShortMemoryTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { ros::Time::init(); }

  Node makeNode() { return Node(directory_.path()); }

  /// Lets the first allocation of a call fail, then the second, until it succeeds: those alone, and
  /// with all after them.
  template <class Service>
  void expectAllOrNothing(Handler<Service> handle, const typename Service::Request& request) {
    for (const long failing : {1L, ShortMemory::kAll}) {
      SCOPED_TRACE(failing);
      bool succeeded = false;
      long failures = 0;
      for (; !succeeded; ++failures) {
        succeeded = succeedsOrChangesNothing<Service>(handle, request, failures, failing);
        if (HasFatalFailure()) return;
      }
      EXPECT_GT(failures, 1) << "nothing failed";
    }
  }

  template <class Service>
  bool succeedsOrChangesNothing(Handler<Service> handle, const typename Service::Request& request,
                                long succeeding, long failing) {
    Node node(directory_.path());
    const std::string before = node.bits();
    Client<Service> client(node, handle, request);
    const auto response = client.callShortOfMemory(succeeding, failing);
    if (!response.success) {
      EXPECT_EQ(node.bits(), before) << "after " << succeeding << " allocations";
      EXPECT_NE(response.message, "");
      EXPECT_TRUE(client.call().success);
    }
    return response.success;
  }

  const TemporaryDirectory directory_;
};

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
