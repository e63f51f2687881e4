// Faults in callbacks are logged: uncaught ones would end the node, and stop a timer for good.
#pragma once

#include <ros/console.h>

#include <cstdio>
#include <exception>
#include <new>
#include <system_error>

#include "node/throttle.h"
#include "simulation/runner.h"

namespace spherical_springs {

inline const char* wordsFor(core::Refusal::Reason reason) {
  using Reason = core::Refusal::Reason;
  switch (reason) {
    case Reason::stepping:
      return "a ~step is under way; wait for it or end it by ~cancel";
    case Reason::relaxing:
      return "a ~relax is under way; wait for it or end it by ~cancel";
    case Reason::running:
      return "the simulation is running; pause it first by ~set_running";
    case Reason::closed:
      return "the node is shutting down";
  }
  return "";
}

/// Says what went wrong, in words for the log and for answers.
inline const char* reasonOf(const std::exception& fault) {
  if (dynamic_cast<const std::bad_alloc*>(&fault) != nullptr) {
    return "there is not enough memory for this";
  }
  if (const auto* refusal = dynamic_cast<const core::Refusal*>(&fault)) {
    return wordsFor(refusal->reason());
  }
  const auto* error = dynamic_cast<const std::system_error*>(&fault);
  if (error != nullptr && error->code() == std::errc::resource_unavailable_try_again) {
    return "no thread could be started for this: there is not enough memory, or too many are there";
  }
  return fault.what();
}

/// Logs "`consequence`: `reason`"; on standard error alone where there is no memory for the log.
inline void logFault(const char* consequence, const char* reason) noexcept {
  try {
    ROS_ERROR("%s: %s", consequence, reason);
  } catch (...) {
    std::fprintf(stderr, "%s: %s\n", consequence, reason);
  }
}

/// Does `work`; if it throws, logs "`consequence`: the reason", every ten seconds at most from one
/// place in the code, and goes on.
/// @return whether `work` came to its end.
template <class Work>
bool runLoggingFaults(const char* consequence, const Work& work) noexcept {
  static Throttle throttle(std::chrono::seconds(10));  // one for each type of `work`
  try {
    work();
    return true;
  } catch (const std::exception& fault) {
    if (throttle.isDue()) logFault(consequence, reasonOf(fault));
  } catch (...) {
    if (throttle.isDue()) logFault(consequence, "unknown");
  }
  return false;
}

/// Returns a callback of a timer that does `work`, logs what it throws, and tries again at the next
/// tick.
template <class Work>
auto loggingFaults(const char* consequence, const Work& work) {
  return [consequence, work](const auto&) { runLoggingFaults(consequence, work); };
}

}  // namespace spherical_springs
