#include "node/unknown_parameters.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

#include "spherical_springs/range.h"

namespace spherical_springs {
namespace {

/// Parameters that ROS itself reads: those of diagnostic_updater, and of the actions' servers.
const std::vector<std::string> kOfRos = {"actionlib_status_frequency", "diagnostic_period",
                                         "diagnostic_updater", "relax", "step"};

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// The number of letters to put in, take out or change to make `b` of `a`.
std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t changed = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({changed, diagonal + 1, row[j] + 1});
    }
  }
  return row.back();
}

}  // namespace

const std::string& nearestName(const std::string& name, const std::vector<std::string>& known) {
  return *std::min_element(known.begin(), known.end(), [&](const auto& a, const auto& b) {
    return distance(name, a) < distance(name, b);
  });
}

void warnOfUnknownParameters(const ros::NodeHandle& node, const std::vector<std::string>& known) {
  XmlRpc::XmlRpcValue all;
  if (!node.getParam(node.getNamespace(), all)) return;
  if (all.getType() != XmlRpc::XmlRpcValue::TypeStruct) return;
  for (const auto& parameter : all) {
    const std::string& name = parameter.first;
    if (contains(known, name) || contains(kOfRos, name)) continue;
    ROS_WARN("parameter ~%s is none of this node's, and is not used; the nearest is ~%s",
             core::shortened(name).c_str(), nearestName(name, known).c_str());
  }
}

}  // namespace spherical_springs
