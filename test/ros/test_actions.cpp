// The actions of the node that the launch file has started, by the client of actionlib in C++.
#include <actionlib/client/simple_action_client.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <spherical_springs/AddParticles.h>
#include <spherical_springs/AddSprings.h>
#include <spherical_springs/RelaxAction.h>
#include <spherical_springs/StepAction.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <cmath>
#include <string>

namespace spherical_springs {
namespace {

using State = actionlib::SimpleClientGoalState;

const ros::Duration kLong(60);

std::string nameOf(const char* name) { return std::string("/spherical_springs/") + name; }

template <class Service>
void call(const char* name, Service& service) {
  ASSERT_TRUE(ros::service::waitForService(nameOf(name), kLong));
  ASSERT_TRUE(ros::service::call(nameOf(name), service));
  ASSERT_TRUE(service.response.success) << service.response.message;
}

/// Two particles a right angle apart, and a spring that would have them twice as far.
class Actions : public ::testing::Test {
 protected:
  void SetUp() override {
    std_srvs::SetBool running;
    call("set_running", running);
    std_srvs::Trigger clear;
    call("clear", clear);
    AddParticles particles;
    particles.request.particles.resize(2);
    particles.request.particles[0].position.x = 1;
    particles.request.particles[1].position.y = 1;
    call("add_particles", particles);
    AddSprings springs;
    springs.request.angle_springs.resize(1);
    for (std::size_t end = 0; end < 2; ++end) {
      springs.request.angle_springs[0].particles[end] = particles.response.ids.at(end);
    }
    springs.request.angle_springs[0].rest_angle = 2;
    springs.request.angle_springs[0].stiffness = 1;
    call("add_springs", springs);
  }
};

TEST_F(Actions, Relaxes) {
  actionlib::SimpleActionClient<RelaxAction> client(nameOf("relax"));
  ASSERT_TRUE(client.waitForServer(kLong));
  EXPECT_EQ(client.sendGoalAndWait({}, kLong), State::SUCCEEDED);
  const auto result = client.getResult();
  EXPECT_TRUE(result->success);
  EXPECT_TRUE(result->converged);
  EXPECT_NEAR(result->energy_before, std::pow(2 - std::acos(0.), 2) / 2, 1e-12);
  EXPECT_NEAR(result->energy_after, 0, 1e-15);
}

TEST_F(Actions, StepsUntilItIsPreempted) {
  actionlib::SimpleActionClient<StepAction> client(nameOf("step"));
  ASSERT_TRUE(client.waitForServer(kLong));
  StepGoal goal;
  goal.steps = ~0u;
  std::uint64_t steps = 0;
  client.sendGoal(goal, {}, {}, [&](const StepFeedbackConstPtr& feedback) {
    steps = feedback->steps;
    if (steps > 0) client.cancelGoal();
  });
  ASSERT_TRUE(client.waitForResult(kLong));
  EXPECT_EQ(client.getState(), State::PREEMPTED);
  const auto result = client.getResult();
  EXPECT_TRUE(result->success);
  EXPECT_GT(steps, 0u);
  EXPECT_GE(result->steps, steps);
  EXPECT_EQ(client.getState().getText(), result->message);
}

TEST_F(Actions, RefusesBadGoals) {
  actionlib::SimpleActionClient<RelaxAction> client(nameOf("relax"));
  ASSERT_TRUE(client.waitForServer(kLong));
  RelaxGoal goal;
  goal.tolerance = -1;
  EXPECT_EQ(client.sendGoalAndWait(goal, kLong), State::REJECTED);
  EXPECT_FALSE(client.getResult()->success);
  EXPECT_NE(client.getState().getText().find("tolerance is -1; allowed"), std::string::npos);
}

}  // namespace
}  // namespace spherical_springs

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "actions_in_cpp", ros::init_options::AnonymousName);
  const ros::NodeHandle node;
  return RUN_ALL_TESTS();
}
