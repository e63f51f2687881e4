#pragma once

#include <ros/console.h>

#include <chrono>
#include <cstdio>
#include <exception>
#include <string>
#include <utility>

#include "node/faults.h"
#include "node/news.h"
#include "node/throttle.h"
#include "spherical_springs/range.h"

namespace spherical_springs {

/// Tells of refused calls of one service or action, as clients may not look at what it answers: in
/// the log, once a second at most, and in /diagnostics. For many threads.
class Refusals {
 public:
  /// `name`: without the leading `~`. `news` must live longer.
  Refusals(std::string name, News& news) : name_(std::move(name)), news_(news) {}

  void tell(const std::exception& fault) noexcept {
    const char* reason = reasonOf(fault);
    if (dynamic_cast<const core::NonFinite*>(&fault) != nullptr) news_.refused(reason);
    if (!throttle_.isDue()) return;
    try {
      ROS_WARN("~%s refused: %s", name_.c_str(), reason);
    } catch (...) {
      std::fprintf(stderr, "~%s refused: %s\n", name_.c_str(), reason);
    }
  }

 private:
  const std::string name_;
  News& news_;
  Throttle throttle_{std::chrono::seconds(1)};
};

}  // namespace spherical_springs
