// The work of ~map_mesh without a network.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "node/map_handler.h"

namespace spherical_springs {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

MapMeshGoal octahedron() {
  MapMeshGoal goal;
  const double corners[][3] = {{2, 0, 0}, {-2, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (const auto& corner : corners) {
    geometry_msgs::Point point;
    point.x = corner[0];
    point.y = corner[1];
    point.z = corner[2];
    goal.mesh.vertices.push_back(point);
  }
  const std::uint32_t faces[][3] = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                    {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (const auto& face : faces) {
    shape_msgs::MeshTriangle triangle;
    for (int k = 0; k < 3; ++k) triangle.vertex_indices[k] = face[k];
    goal.mesh.triangles.push_back(triangle);
  }
  return goal;
}

class Following : public MapFollower {
 public:
  bool goesOn(const mesh::MapProgress& progress) noexcept override {
    ++calls;
    return going_on(progress);
  }
  void cancelled() noexcept override { was_cancelled = true; }

  std::function<bool(const mesh::MapProgress&)> going_on = [](const auto&) { return true; };
  int calls = 0;
  bool was_cancelled = false;
};

class MapHandlerTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { ros::Time::init(); }

  std::string refusal(const MapMeshGoal& goal) {
    MapMeshResult result;
    try {
      handler_.map(goal, result, follower_);
    } catch (const std::exception& fault) {
      EXPECT_EQ(runner_.read([](const core::Simulation& s) { return s.scene().springCount(); }),
                0u);
      return fault.what();
    }
    return "no refusal";
  }

  void expectRefused(const std::function<void(MapMeshGoal&)>& spoil, const std::string& reason) {
    MapMeshGoal goal = octahedron();
    spoil(goal);
    EXPECT_EQ(refusal(goal), reason);
    EXPECT_EQ(follower_.calls, 0) << "accepted: " << reason;
  }

  core::Runner runner_{{}, false};
  News news_;
  MapTurn turn_;
  MapHandler handler_{runner_, news_, turn_, {50, 100}, 1};
  Following follower_;
};

TEST_F(MapHandlerTest, Maps) {
  MapMeshResult result;
  handler_.map(octahedron(), result, follower_);
  ASSERT_EQ(result.sphere.size(), 6u);
  for (const auto& p : result.sphere) EXPECT_NEAR(p.x * p.x + p.y * p.y + p.z * p.z, 1, 1e-14);
  EXPECT_LE(result.spread, 1e-3);
  EXPECT_GE(result.worst, result.spread);
  EXPECT_GT(result.worst_angle, result.mean_angle);
  EXPECT_GT(result.mean_angle, 0);
  EXPECT_EQ(result.folded, 0u);
  EXPECT_EQ(result.message.substr(0, 14), "mapped; spread");
  EXPECT_GT(follower_.calls, 0);
  EXPECT_EQ(runner_.present().scene.particles().size(), 0u);
}

TEST_F(MapHandlerTest, TakesDensitiesAndAStart) {
  MapMeshGoal goal = octahedron();
  goal.density = {1, 1, 1, 1, 3, 3, 3, 3};
  goal.start = goal.mesh.vertices;
  MapMeshResult result;
  handler_.map(goal, result, follower_);
  EXPECT_LE(result.spread, 1e-3);
  double z = 0;  // of the four vertices between the heavy half and the other
  for (int v = 0; v < 4; ++v) z += result.sphere[v].z / 4;
  EXPECT_GT(z, 0.3);
}

TEST_F(MapHandlerTest, RefusesBadGoalsBeforeItBegins) {
  expectRefused([](auto& g) { g.mesh.triangles[5].vertex_indices[2] = 6; },
                "mesh.triangles[5].vertex_indices[2] is 6; allowed: 0 to 5");
  expectRefused([](auto& g) { g.mesh.triangles[0].vertex_indices[0] = ~0u; },
                "mesh.triangles[0].vertex_indices[0] is 4294967295; allowed: 0 to 5");
  expectRefused([](auto& g) { g.mesh.vertices.clear(); },
                "mesh.triangles[0].vertex_indices[0] is 0; the mesh has no vertices");
  expectRefused([](auto& g) { g = {}; }, "mesh: the number of faces is 0; allowed: 4 or more");
  expectRefused([](auto& g) { g.mesh.vertices[3].y = kNan; },
                "mesh.vertices[3].y is nan; allowed: any finite number");
  expectRefused(
      [](auto& g) { g.mesh.triangles.pop_back(); },
      "mesh: the mesh is open: it has 1 hole, of 3 edges; edge 3-0 has no face but face 3");
  expectRefused(
      [](auto& g) {
        g.density = {1, 2};
      },
      "density has 2 items; allowed: none, or one a triangle, which are 8");
  expectRefused([](auto& g) { g.density = {1, 1, 1, -2, 1, 1, 1, 1}; },
                "density[3] is -2; allowed: above 0");
  expectRefused(
      [](auto& g) { g.density = {1, 1, 1, 1, 1, 1, 1, 1e9}; },
      "mesh: face 7 is to have 99.9999 % of the sphere; allowed: up to 45 %, as a triangle on "
      "the sphere has less than half of it");
  expectRefused([](auto& g) { g.start.resize(5); },
                "start has 5 items; allowed: none, or one a vertex, which are 6");
  expectRefused([](auto& g) { g.start.resize(6); },
                "mesh: vertex 0 of the start is zero or not finite");
  expectRefused([](auto& g) { g.spread = -1; }, "spread is -1; allowed: 0 (meaning 1e-3) or more");
  expectRefused([](auto& g) { g.spread = kNan; },
                "spread is nan; allowed: 0 (meaning 1e-3) or more");
  expectRefused([](auto& g) { g.max_time = -0.5; },
                "max_time is -0.5; allowed: 0 (by the number of vertices) or more [s]");
  expectRefused([](auto& g) { g.angle_weight = 2e6; }, "angle_weight is 2e+06; allowed: 0 to 1e6");
}

TEST_F(MapHandlerTest, LoadsTheMap) {
  MapMeshGoal goal = octahedron();
  goal.load = true;
  MapMeshResult result;
  handler_.map(goal, result, follower_);
  const core::Scene scene = runner_.present().scene;
  ASSERT_EQ(scene.particles().size(), 6u);
  EXPECT_EQ(scene.springCount(), 20u);
  for (std::size_t v = 0; v < 6; ++v) {
    EXPECT_NEAR(scene.particles().item(v).position.x(), result.sphere[v].x, 1e-15);
  }
  EXPECT_NE(result.message.find("the map is the scene"), std::string::npos);
}

TEST_F(MapHandlerTest, RefusesToLoadWhatHasNoRoom) {
  MapHandler handler(runner_, news_, turn_, {5, 100}, 1), other(runner_, news_, turn_, {6, 19}, 1);
  MapMeshGoal goal = octahedron();
  MapMeshResult result;
  EXPECT_NO_THROW(handler.map(goal, result, follower_));
  goal.load = true;
  follower_.calls = 0;
  EXPECT_THROW(handler.map(goal, result, follower_), std::invalid_argument);
  EXPECT_THROW(other.map(goal, result, follower_), std::invalid_argument);
  EXPECT_EQ(follower_.calls, 0);
}

// The map is not lost where somebody relaxes or steps in the end.
TEST_F(MapHandlerTest, DoesNotLoadWhileAStepIsUnderWay) {
  MapMeshGoal goal = octahedron();
  goal.load = true;
  MapMeshResult result;
  runner_.step([](double, const auto& done) { return done.steps == 0 ? 1 : 0; },
               [&] { EXPECT_THROW(handler_.map(goal, result, follower_), std::runtime_error); });
  EXPECT_EQ(result.sphere.size(), 6u);
  EXPECT_EQ(runner_.present().scene.particles().size(), 0u);
}

TEST_F(MapHandlerTest, EndsWithTheBestMapSoFar) {
  MapMeshGoal goal = octahedron();
  goal.density = {1, 2, 3, 1, 2, 3, 1, 2};
  goal.spread = 1e-300;
  goal.max_time = 1e6;
  follower_.going_on = [](const mesh::MapProgress& p) { return std::isinf(p.spread); };
  MapMeshResult result;
  handler_.map(goal, result, follower_);
  EXPECT_TRUE(follower_.was_cancelled);
  EXPECT_EQ(result.sphere.size(), 6u);
  EXPECT_EQ(result.message.substr(0, 24), "cancelled; best map so f");
  follower_.going_on = [&](const mesh::MapProgress& p) {
    if (std::isfinite(p.spread)) turn_.cancel();
    return true;
  };
  handler_.map(goal, result, follower_);
  EXPECT_EQ(result.message.substr(0, 10), "cancelled;");
}

TEST_F(MapHandlerTest, EndsWithoutAMapWhereItIsCancelledBefore) {
  follower_.going_on = [](const auto&) { return false; };
  MapMeshGoal goal = octahedron();
  goal.angle_weight = 0.1;  // with areas alone its projection would be the map
  EXPECT_EQ(refusal(goal), "cancelled before there was a map; nothing has changed");
  EXPECT_TRUE(follower_.was_cancelled);
}

TEST_F(MapHandlerTest, MapsOneMeshAtATime) {
  EXPECT_FALSE(turn_.cancel());
  {
    const MapTurn::Busy busy(turn_);
    EXPECT_EQ(refusal(octahedron()), "a ~map_mesh is under way; wait for it or end it by ~cancel");
    EXPECT_FALSE(turn_.cancelled());
    EXPECT_TRUE(turn_.cancel());
    EXPECT_TRUE(turn_.cancelled());
  }
  EXPECT_EQ(refusal(octahedron()), "no refusal");
  turn_.close();
  EXPECT_EQ(refusal(octahedron()), "the node is shutting down");
}

}  // namespace
}  // namespace spherical_springs
