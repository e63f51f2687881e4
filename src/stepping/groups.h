// Elements of a patch in groups that kernels take.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "stepping/row.h"

namespace spherical_springs::core {

constexpr std::uint32_t roundedUpToGroup(std::uint32_t count) {
  return (count + kGroup - 1) / kGroup * kGroup;
}

/// Where some elements of a patch are in a list of groups. Those that kernels take together lie far
/// apart on the sphere, so that they do not wait for each other's sums.
struct GroupRange {
  std::uint32_t begin = 0, end = 0;

  std::uint32_t groupOf(std::uint32_t element) const { return begin + element % (end - begin); }
  std::uint32_t laneOf(std::uint32_t element) const { return element / (end - begin); }
  std::uint32_t elementAt(std::uint32_t group, std::uint32_t lane) const {
    return lane * (end - begin) + group - begin;
  }
};

/// Adds groups for `count` elements: `set(element, group, lane)` puts one in its place, and again
/// the last one in places left over, from which `slacken(group, lane)` takes its effect.
template <class Group, class Set, class Slacken>
GroupRange appendGroups(std::uint32_t count, std::vector<Group>& groups, const Set& set,
                        const Slacken& slacken) {
  const auto begin = static_cast<std::uint32_t>(groups.size());
  const std::uint32_t room = roundedUpToGroup(count);
  const GroupRange range = {begin, begin + room / static_cast<std::uint32_t>(kGroup)};
  groups.resize(range.end);
  for (std::uint32_t i = 0; i < room; ++i) {
    Group& group = groups[range.groupOf(i)];
    const std::uint32_t lane = range.laneOf(i);
    set(std::min(i, count - 1), group, lane);
    if (i >= count) slacken(group, lane);
  }
  return range;
}

}  // namespace spherical_springs::core
