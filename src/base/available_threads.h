// The number of threads that the system lets this process run at once.
#pragma once

#include <filesystem>

namespace spherical_springs::core {

/// The smallest quota of processor time among the control groups (cgroups) of this process and
/// their ancestors, in processors: 1.5 for 150 ms of each 100 ms. Infinite where there is none, or
/// none that can be read. `root` is the directory that `proc` and the control groups are found in.
double processorQuota(const std::filesystem::path& root = "/");

/// The number of processors that the calling thread may run on, or the quota, rounded up, where
/// that is less; at least 1.
int availableThreads(const std::filesystem::path& root = "/");

}  // namespace spherical_springs::core
