// Threads that a process may use, by affinity and by quotas of control groups in made-up file
// systems.
#include <gtest/gtest.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <thread>
#include <utility>

#include "base/available_threads.h"

namespace spherical_springs::core {
namespace {

namespace fs = std::filesystem;

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

/// A directory with files that stands for the root of a file system.
class ProcessorQuota : public ::testing::Test {
 protected:
  ProcessorQuota() { fs::create_directory(root_); }
  ~ProcessorQuota() override { fs::remove_all(root_); }

  void write(const fs::path& path, const std::string& text) {
    fs::create_directories((root_ / path).parent_path());
    std::ofstream(root_ / path) << text;
  }

  /// As systemd and Docker mount version 2.
  void mountVersion2(const std::string& group, const std::string& mounted = "/") {
    write("proc/self/cgroup", "0::" + group + "\n");
    write("proc/self/mountinfo",
          "22 28 0:21 / /proc rw,nosuid shared:12 - proc proc rw\n"
          "30 23 0:26 " +
              mounted + " /sys/fs/cgroup rw,nosuid shared:9 - cgroup2 cgroup2 rw\n");
  }

  /// As Docker mounts version 1, beside a version 2 without controllers.
  void mountVersion1(const std::string& group, const std::string& mounted = "/") {
    write("proc/self/cgroup", "12:cpuset:/elsewhere\n4:cpu,cpuacct:" + group + "\n0::/\n");
    write("proc/self/mountinfo",
          "31 23 0:28 / /sys/fs/cgroup rw,relatime - tmpfs tmpfs rw,mode=755\n"
          "32 31 0:29 " +
              mounted +
              " /sys/fs/cgroup/cpu rw master:3 - cgroup cgroup rw,cpu,cpuacct\n"
              "34 31 0:31 / /sys/fs/cgroup/cpuset rw - cgroup cgroup rw,cpuset\n"
              "41 31 0:38 / /sys/fs/cgroup/unified rw - cgroup2 cgroup2 rw\n");
  }

  void setVersion1(const fs::path& group, long quota, long period = 100000) {
    write("sys/fs/cgroup/cpu" / group / "cpu.cfs_quota_us", std::to_string(quota) + "\n");
    write("sys/fs/cgroup/cpu" / group / "cpu.cfs_period_us", std::to_string(period) + "\n");
  }

  double quota() const { return processorQuota(root_); }
  const fs::path& root() const { return root_; }

 private:
  const fs::path root_ =
      fs::temp_directory_path() / ("spherical_springs_quota_" + std::to_string(::getpid()));
};

TEST_F(ProcessorQuota, IsInfiniteWithoutFiles) { EXPECT_EQ(quota(), kUnlimited); }

TEST_F(ProcessorQuota, IsThatOfTheGroupInVersion2) {
  mountVersion2("/robot.slice/node.service");
  EXPECT_EQ(quota(), kUnlimited);
  write("sys/fs/cgroup/robot.slice/node.service/cpu.max", "150000 100000\n");
  EXPECT_EQ(quota(), 1.5);
  write("sys/fs/cgroup/robot.slice/node.service/cpu.max", "max 100000\n");
  EXPECT_EQ(quota(), kUnlimited);
}

TEST_F(ProcessorQuota, IsTheSmallestOfAllAncestors) {
  mountVersion2("/a/b/c");
  write("sys/fs/cgroup/a/b/c/cpu.max", "400000 100000\n");
  write("sys/fs/cgroup/a/b/cpu.max", "max 100000\n");
  write("sys/fs/cgroup/a/cpu.max", "100000 50000\n");
  EXPECT_EQ(quota(), 2);
  write("sys/fs/cgroup/cpu.max", "25000 100000\n");  // as a container sees its own
  EXPECT_EQ(quota(), 0.25);
}

TEST_F(ProcessorQuota, IsNotThatOfOtherGroups) {
  mountVersion2("/a/b");
  for (const char* other : {"a/b/c", "a/c", "b"}) {
    write(fs::path("sys/fs/cgroup") / other / "cpu.max", "10000 100000\n");
  }
  EXPECT_EQ(quota(), kUnlimited);
}

TEST_F(ProcessorQuota, IsFoundInVersion1) {
  mountVersion1("/a/b");
  setVersion1("a/b", -1);
  setVersion1("a", 320000);
  EXPECT_EQ(quota(), 3.2);
  setVersion1("a/b", 50000, 20000);
  EXPECT_EQ(quota(), 2.5);
  // Other controllers have nothing to say, nor have groups of the same name under them.
  write("sys/fs/cgroup/cpuset/elsewhere/cpu.max", "1000 100000\n");
  setVersion1("elsewhere", 1000);
  EXPECT_EQ(quota(), 2.5);
}

TEST_F(ProcessorQuota, IsFoundWhereOnlyAPartOfTheHierarchyIsMounted) {
  mountVersion1("/docker/1234/inner", "/docker/1234");
  setVersion1("inner", 200000);
  EXPECT_EQ(quota(), 2);
  setVersion1("", 100000);
  EXPECT_EQ(quota(), 1);
  mountVersion1("/docker/1234", "/docker/1234");
  setVersion1("", 300000);
  EXPECT_EQ(quota(), 3);
  // Not within what is mounted.
  for (const char* group : {"/", "/docker/5678", "/../outside"}) {
    mountVersion1(group, "/docker/1234");
    EXPECT_EQ(quota(), 3) << group;
  }
}

TEST_F(ProcessorQuota, PassesOverWhatItCannotRead) {
  mountVersion2("/a");
  for (const char* text : {"", "\n", "max", "lots 100000", "100000", "100000 0", "-5 100000",
                           "0 100000", "1e999 100000", "nan nan", "\xff\xfe", "100000 -1"}) {
    write("sys/fs/cgroup/a/cpu.max", text);
    EXPECT_EQ(quota(), kUnlimited) << text;
  }
  write("sys/fs/cgroup/a/cpu.max", "50000 100000");
  EXPECT_EQ(quota(), 0.5);
  for (const char* text : {"", "0", "0:", "0:\n:\n::\n", "no group\n", ":::::\n", "0::\n"}) {
    write("proc/self/cgroup", text);
    EXPECT_EQ(quota(), kUnlimited) << text;
  }
  mountVersion2("/a");
  for (const char* text : {"", "\n", " - \n", "30 23 0:26 - cgroup2 cgroup2 rw\n", "- - - - -\n",
                           "30 23 0:26 / /sys/fs/cgroup rw cgroup2 cgroup2 rw\n"}) {
    write("proc/self/mountinfo", text);
    EXPECT_EQ(quota(), kUnlimited) << text;
  }
}

TEST_F(ProcessorQuota, IsRoundedUpToThreads) {
  const int processors = availableThreads(root());
  mountVersion2("/a");
  for (const auto& [quota, threads] : {std::pair("1000", 1), std::pair("100000", 1),
                                       std::pair("100001", 2), std::pair("99900000000", 999000)}) {
    write("sys/fs/cgroup/a/cpu.max", std::string(quota) + " 100000");
    EXPECT_EQ(availableThreads(root()), std::min(threads, processors)) << quota;
  }
}

TEST(AvailableThreads, AreThoseThatTheAffinityAllows) {
  cpu_set_t all;
  ASSERT_EQ(sched_getaffinity(0, sizeof all, &all), 0);
  EXPECT_GE(availableThreads(), 1);
  EXPECT_LE(availableThreads(), CPU_COUNT(&all));
  int first = 0;
  while (!CPU_ISSET(first, &all)) ++first;
  std::thread([&] {  // which alone is bound
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(first, &one);
    ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
    EXPECT_EQ(availableThreads(), 1);
  })
      .join();
}

}  // namespace
}  // namespace spherical_springs::core
