#include <gtest/gtest.h>
#include <sched.h>
#include <spherical_springs/SteppingConfig.h>

#include <limits>
#include <stdexcept>
#include <string>
#include <thread>

#include "node/parameters.h"
#include "spherical_springs/range.h"

namespace spherical_springs {
namespace {

TEST(Parameters, LeaveTheNumberOfThreadsToTheAffinity) {
  Parameters parameters;
  std::thread([&] {  // which alone is bound
    cpu_set_t allowed;
    ASSERT_EQ(sched_getaffinity(0, sizeof allowed, &allowed), 0);
    int first = 0;
    while (!CPU_ISSET(first, &allowed)) ++first;
    CPU_ZERO(&allowed);
    CPU_SET(first, &allowed);
    ASSERT_EQ(sched_setaffinity(0, sizeof allowed, &allowed), 0);
    EXPECT_EQ(parameters.simulation().system.threads, 1);
    parameters.threads = 5;
    EXPECT_EQ(parameters.simulation().system.threads, 5);
  })
      .join();
}

std::string refusalOf(const Pace& pace) {
  try {
    pace.requireValid();
  } catch (const std::invalid_argument& fault) {
    return fault.what();
  }
  return "";
}

Pace paceWith(double Pace::*field, double value) {
  Pace pace;
  pace.*field = value;
  return pace;
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(Pace, IsValidWithinItsLimits) {
  EXPECT_EQ(refusalOf({}), "");
  for (const double value : {1e-12, 1e6}) {
    EXPECT_EQ(refusalOf(paceWith(&Pace::time_step, value)), "");
  }
  for (const double value : {1e-6, 1e6}) {
    EXPECT_EQ(refusalOf(paceWith(&Pace::real_time_factor, value)), "");
  }
  for (const double value : {1e-3, 1e4}) {
    EXPECT_EQ(refusalOf(paceWith(&Pace::publish_rate, value)), "");
  }
  for (const char* name : {"euler", "verlet", "fourth_order", "implicit_euler"}) {
    Pace pace;
    pace.integrator = name;
    EXPECT_EQ(refusalOf(pace), "");
    EXPECT_STREQ(core::nameOf(core::integrationMethod(name)), name);
  }
}

TEST(Pace, NamesWhatIsBeyondThem) {
  EXPECT_EQ(refusalOf(paceWith(&Pace::time_step, -1)),
            "parameter ~time_step is -1; allowed: 1e-12 to 1e6 [s]");
  EXPECT_EQ(refusalOf(paceWith(&Pace::real_time_factor, 0)),
            "parameter ~real_time_factor is 0; allowed: 1e-6 to 1e6");
  EXPECT_EQ(refusalOf(paceWith(&Pace::publish_rate, 20000)),
            "parameter ~publish_rate is 20000; allowed: 0.001 to 10000 [Hz]");
  Pace pace;
  pace.integrator = "leapfrog";
  EXPECT_EQ(refusalOf(pace),
            "parameter ~integrator is 'leapfrog'; allowed: euler, verlet, fourth_order, "
            "implicit_euler, automatic");
  EXPECT_EQ(refusalOf(paceWith(&Pace::accuracy, -1e-6)),
            "parameter ~accuracy is -1e-06; allowed: 0 (off) to 1e6 [rad/s]");
}

TEST(Pace, NeedsAnAccuracyToChooseAnIntegrator) {
  Pace pace;
  pace.integrator = "automatic";
  EXPECT_EQ(refusalOf(pace),
            "parameter ~integrator is 'automatic' while ~accuracy is 0; allowed: 'automatic' with "
            "an ~accuracy above 0 [rad/s], or one of the other integrators");
  pace.accuracy = 1e-300;
  EXPECT_EQ(refusalOf(pace), "");
  EXPECT_TRUE(pace.stepWish().chooses_method);
  EXPECT_EQ(pace.stepWish().accuracy, 1e-300);
}

TEST(Pace, SaysHowToStep) {
  Pace pace;
  pace.time_step = 0.25;
  pace.integrator = "euler";
  EXPECT_EQ(pace.stepWish().method, core::IntegrationMethod::euler);
  EXPECT_EQ(pace.stepWish().time_step, 0.25);
  EXPECT_EQ(pace.stepWish().accuracy, 0);
  EXPECT_FALSE(pace.stepWish().chooses_method);
}

TEST(Pace, TellsNumbersThatAreNotFiniteFromOthers) {
  for (const double value : {kNaN, kInfinity, -kInfinity}) {
    EXPECT_THROW(paceWith(&Pace::accuracy, value).requireValid(), core::NonFinite);
    EXPECT_THROW(paceWith(&Pace::time_step, value).requireValid(), core::NonFinite);
  }
  EXPECT_EQ(refusalOf(paceWith(&Pace::publish_rate, kNaN)),
            "parameter ~publish_rate is nan; allowed: 0.001 to 10000 [Hz]");
  try {
    paceWith(&Pace::time_step, 0).requireValid();
    FAIL();
  } catch (const core::NonFinite&) {
    FAIL() << "0 is finite";
  } catch (const std::invalid_argument&) {
  }
}

TEST(Pace, NamesWhatDiffers) {
  Pace pace;
  EXPECT_EQ(pace.differenceFrom({}), "");
  pace.time_step = 0.25;
  pace.integrator = "euler";
  pace.running = false;
  EXPECT_EQ(pace.differenceFrom({}),
            "~time_step is 0.25, ~integrator is 'euler', ~running is false");
}

TEST(Pace, HasTheDefaultsOfTheConfiguration) {
  const Pace pace;
  const auto expectEqual = [](const char* name, const auto& value, const auto& shown) {
    EXPECT_EQ(value, shown) << name;
  };
  Pace::forEachField(expectEqual, pace, SteppingConfig::__getDefault__());
}

}  // namespace
}  // namespace spherical_springs
