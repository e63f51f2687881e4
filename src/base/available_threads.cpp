#include "base/available_threads.h"

#include <sched.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace spherical_springs::core {
namespace {

namespace fs = std::filesystem;

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

/// The processors that the calling thread may run on.
int allowedProcessors() {
  constexpr std::size_t kMostSets = 1024;  // of 1024 processors each
  for (std::size_t count = 1; count <= kMostSets; count *= 2) {
    std::vector<cpu_set_t> sets(count);  // fails while that is smaller than the kernel's own set
    const std::size_t bytes = count * sizeof(cpu_set_t);
    if (sched_getaffinity(0, bytes, sets.data()) == 0) return CPU_COUNT_S(bytes, sets.data());
  }
  return static_cast<int>(std::thread::hardware_concurrency());
}

/// Whether `name` is one of the names in a list with commas.
bool names(const std::string& list, const std::string& name) {
  return ("," + list + ",").find("," + name + ",") != std::string::npos;
}

/// The control groups of this process that may have a quota, as paths within the hierarchies of
/// both versions. Empty where a hierarchy is not in use.
struct Groups {
  std::string version_1, version_2;
};

/// Reads lines like `4:cpu,cpuacct:/path` and `0::/path` (man 7 cgroups).
Groups groupsOf(std::istream&& lines) {
  Groups groups;
  for (std::string line; std::getline(lines, line);) {
    const auto first = line.find(':');
    const auto second = first == std::string::npos ? first : line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    if (controllers.empty()) groups.version_2 = line.substr(second + 1);
    if (names(controllers, "cpu")) groups.version_1 = line.substr(second + 1);
  }
  return groups;
}

/// A hierarchy of control groups, or the part of it below `root`, that is mounted at `point`.
struct Mount {
  std::string root, point, type, options;

  const std::string* groupIn(const Groups& groups) const {
    if (type == "cgroup2") return &groups.version_2;
    return type == "cgroup" && names(options, "cpu") ? &groups.version_1 : nullptr;
  }
};

/// Reads lines like `36 35 98:0 /root /point rw,relatime master:1 - type source options` (man 5
/// proc).
std::vector<Mount> mountsOf(std::istream&& lines) {
  std::vector<Mount> mounts;
  for (std::string line; std::getline(lines, line);) {
    const auto separator = line.find(" - ");
    if (separator == std::string::npos) continue;
    std::istringstream before(line), after(line.substr(separator + 3));
    std::string passed_over;
    Mount mount;
    before >> passed_over >> passed_over >> passed_over >> mount.root >> mount.point;
    after >> mount.type >> passed_over >> mount.options;
    if (before && after) mounts.push_back(mount);
  }
  return mounts;
}

/// The quota of one group: `cpu.max` has both numbers or `max` in version 2; version 1 has a file
/// for each, and -1 where there is none.
double quotaOf(const fs::path& group) {
  double quota = 0, period = 0;
  if (std::ifstream both(group / "cpu.max"); both) {
    both >> quota >> period;
  } else {
    std::ifstream(group / "cpu.cfs_quota_us") >> quota;
    std::ifstream(group / "cpu.cfs_period_us") >> period;
  }
  return quota > 0 && period > 0 ? quota / period : kUnlimited;
}

/// The smallest quota of a group and its ancestors, as far as they are mounted.
double smallestQuota(const std::string& group, const Mount& mount, const fs::path& root) {
  fs::path directory = root / fs::path(mount.point).relative_path();
  double smallest = quotaOf(directory);
  const fs::path below = fs::path(group).lexically_relative(mount.root);
  for (const fs::path& name : below) {
    if (name == "..") return smallest;  // not in the part that is mounted
    directory /= name;
    smallest = std::min(smallest, quotaOf(directory));
  }
  return smallest;
}

}  // namespace

double processorQuota(const fs::path& root) {
  const fs::path self = root / "proc/self";
  const Groups groups = groupsOf(std::ifstream(self / "cgroup"));
  double smallest = kUnlimited;
  for (const Mount& mount : mountsOf(std::ifstream(self / "mountinfo"))) {
    const std::string* const group = mount.groupIn(groups);
    if (group != nullptr) smallest = std::min(smallest, smallestQuota(*group, mount, root));
  }
  return smallest;
}

int availableThreads(const fs::path& root) {
  const double quota = std::ceil(processorQuota(root));
  return static_cast<int>(std::max(1., std::min<double>(quota, allowedProcessors())));
}

}  // namespace spherical_springs::core
