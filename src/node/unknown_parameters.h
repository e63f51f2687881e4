#pragma once

#include <ros/node_handle.h>

#include <string>
#include <vector>

namespace spherical_springs {

/// Returns the name among `known`, which has one at least, that is the nearest to `name`: by the
/// number of letters to put in, take out or change.
const std::string& nearestName(const std::string& name, const std::vector<std::string>& known);

/// Warns of each parameter under `node` that is none of `known`, and names the nearest that is.
void warnOfUnknownParameters(const ros::NodeHandle& node, const std::vector<std::string>& known);

}  // namespace spherical_springs
