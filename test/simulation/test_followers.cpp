// Steps and relaxations that somebody follows and may cancel.
#include <gtest/gtest.h>

#include <vector>

#include "simulation/runner.h"
#include "support/scenes.h"

namespace spherical_springs::core {
namespace {

/// Keeps what it is told, and cancels the work when it has been told as often as asked.
template <class Progress>
class Recorder : public Follower<Progress> {
 public:
  explicit Recorder(std::size_t most) : most_(most) {}

  bool goesOn(const Progress& progress) noexcept override {
    told.push_back(progress);
    return told.size() < most_;
  }
  void cancelled() noexcept override { ++cancels; }

  std::vector<Progress> told;
  int cancels = 0;

 private:
  const std::size_t most_;
};

class Followers : public ::testing::Test {
 protected:
  void SetUp() override {
    const Scene scene = testing::randomScene(1, 100, 150);
    runner_.change([&](Simulation& s) {
      s.addParticles(scene.particles().items());
      s.addSprings(testing::springsOf(scene));
    });
    endless_.method = RelaxationMethod::dynamics;
    endless_.tolerance = 1e-300;
  }

  std::uint64_t step(std::uint64_t steps, StepFollower& follower) {
    const auto left = [steps](double, const Runner::Done& done) { return steps - done.steps; };
    return runner_
        .step(
            left, [] {}, &follower)
        .steps;
  }

  Runner runner_{Simulation::Settings(), false};
  RelaxationOptions endless_;
};

TEST_F(Followers, OfStepsAreToldOfTheBeginningAndTheEnd) {
  Recorder<StepProgress> follower(~std::size_t(0));
  EXPECT_EQ(step(3, follower), 3);
  EXPECT_EQ(follower.told.front().steps, 0);
  EXPECT_EQ(follower.told.front().time, 0);
  EXPECT_EQ(follower.told.back().steps, 3);
  EXPECT_DOUBLE_EQ(follower.told.back().time, 3e-3);
  EXPECT_EQ(follower.cancels, 0);
}

TEST_F(Followers, CancelSteps) {
  Recorder<StepProgress> follower(4);
  const std::uint64_t done = step(~std::uint64_t(0), follower);
  EXPECT_EQ(follower.told.size(), 4);
  EXPECT_EQ(follower.told.back().steps, done);
  EXPECT_EQ(follower.cancels, 1);
  EXPECT_TRUE(runner_.snapshot().state.angular_velocities.isZero(0));
}

TEST_F(Followers, CancelStepsBeforeTheFirst) {
  Recorder<StepProgress> follower(1);
  EXPECT_EQ(step(3, follower), 0);
  EXPECT_EQ(follower.cancels, 1);
}

TEST_F(Followers, CancelRelaxations) {
  Recorder<RelaxProgress> follower(10);
  const RelaxationResult result = runner_.relax(endless_, &follower);
  EXPECT_EQ(follower.told.front().best, nullptr);
  EXPECT_EQ(follower.told.size(), 10);
  EXPECT_EQ(follower.cancels, 1);
  EXPECT_NE(result.message.find("cancelled"), std::string::npos);
  EXPECT_LE(result.energy_after, result.energy_before);
}

TEST_F(Followers, CancelARelaxationThatWaitsForTheLastOne) {
  Recorder<RelaxProgress> first(5), second(2);
  runner_.relax(endless_, &first);
  runner_.relax(endless_, &second);
  EXPECT_EQ(first.cancels, 1);
  EXPECT_EQ(second.cancels, 1);
}

TEST_F(Followers, OfWhatEndsByItselfAreNotToldOfACancel) {
  Recorder<RelaxProgress> follower(~std::size_t(0));
  endless_.max_time = 0.1;
  EXPECT_NE(runner_.relax(endless_, &follower).message.find("max_time"), std::string::npos);
  EXPECT_EQ(follower.cancels, 0);
}

TEST_F(Followers, OfWhatIsRefusedAreToldNothing) {
  Recorder<RelaxProgress> relaxing(1);
  RelaxationOptions bad;
  bad.tolerance = -1;
  EXPECT_THROW(runner_.relax(bad, &relaxing), std::invalid_argument);
  runner_.setRunning(true);
  Recorder<StepProgress> stepping(1);
  EXPECT_THROW(step(1, stepping), Refusal);
  EXPECT_TRUE(relaxing.told.empty());
  EXPECT_TRUE(stepping.told.empty());
}

}  // namespace
}  // namespace spherical_springs::core
