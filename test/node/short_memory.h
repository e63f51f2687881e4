// A node's services, called while memory runs out. To be included by one source of a program, as
// failing_malloc.h is.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>

#include "failing_malloc.h"
#include "node/answering_service.h"
#include "node/handlers.h"
#include "node/map_handler.h"
#include "support/scenes.h"

namespace spherical_springs {

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

inline std::string contentOf(const fs::path& path) {
  std::ostringstream content;
  content << std::ifstream(path).rdbuf();
  return content.str();
}

namespace testing {

inline MapMeshGoal tetrahedronGoal() {
  MapMeshGoal goal;
  goal.mesh.vertices.resize(4);
  goal.mesh.vertices[1].x = goal.mesh.vertices[2].y = goal.mesh.vertices[3].z = 1;
  const std::uint32_t faces[][3] = {{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3}};
  goal.mesh.triangles.resize(4);
  for (int f = 0; f < 4; ++f) {
    for (int k = 0; k < 3; ++k) goal.mesh.triangles[f].vertex_indices[k] = faces[f][k];
  }
  return goal;
}

}  // namespace testing

/// All of a node but what it needs a network for, with a scene that has moved.
struct Node {
  explicit Node(const fs::path& directory)
      : directory(directory), handlers(runner, news, mappings, this->directory, {}, "map") {
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
  MapTurn mappings;
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
      const testing::ShortMemory memory(succeeding, failing);
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
    for (const long failing : {1L, testing::ShortMemory::kAll}) {
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

}  // namespace spherical_springs
