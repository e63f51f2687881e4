#include <gtest/gtest.h>

#include <cerrno>
#include <new>
#include <stdexcept>
#include <system_error>

#include "node/faults.h"

namespace spherical_springs {
namespace {

TEST(Surviving, TellsWhetherTheWorkCameToItsEnd) {
  bool done = false;
  EXPECT_TRUE(runLoggingFaults("this is not said", [&] { done = true; }));
  EXPECT_TRUE(done);
}

TEST(Surviving, OutlivesWhateverIsThrown) {
  EXPECT_FALSE(
      runLoggingFaults("a test's work failed", [] { throw std::runtime_error("as it should"); }));
  EXPECT_FALSE(runLoggingFaults("a test's work failed", [] { throw std::bad_alloc(); }));
  EXPECT_FALSE(runLoggingFaults("a test's work failed", [] { throw 42; }));
}

TEST(Surviving, NamesALackOfMemory) {
  EXPECT_STREQ(reasonOf(std::bad_alloc()), "there is not enough memory for this");
  const std::system_error no_thread(EAGAIN, std::generic_category());
  EXPECT_NE(std::string(reasonOf(no_thread)).find("memory"), std::string::npos);
  EXPECT_STREQ(reasonOf(std::runtime_error("another reason")), "another reason");
}

TEST(Throttle, LetsThroughOnceAPeriod) {
  using namespace std::chrono_literals;
  const Throttle::Clock::time_point begin;
  Throttle throttle(10s);
  EXPECT_TRUE(throttle.isDue(begin));
  EXPECT_FALSE(throttle.isDue(begin));
  EXPECT_FALSE(throttle.isDue(begin + 9s));
  EXPECT_TRUE(throttle.isDue(begin + 10s));
  EXPECT_FALSE(throttle.isDue(begin + 19s));
}

}  // namespace
}  // namespace spherical_springs
