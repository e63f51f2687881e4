#include <gtest/gtest.h>
#include <sched.h>

#include <thread>

#include "node/parameters.h"

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

}  // namespace
}  // namespace spherical_springs
