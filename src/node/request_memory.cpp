#include "node/request_memory.h"

#include <ros/poll_manager.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <thread>

namespace spherical_springs {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kPatience(30);
constexpr std::chrono::milliseconds kNap(10);

// Two, so that small needs do not use up what is there for large requests. Nobody writes to them:
// they take addresses, and no memory of the machine.
constexpr std::array<std::size_t, 2> kReserves = {std::size_t{1} << 20, std::size_t{1} << 24};

thread_local bool reads_requests = false;

// Used by that thread alone, and by others when it has ended.
std::array<void*, kReserves.size()> reserves{};
Clock::time_point first_nap, last_nap;

void holdReserves() {
  reads_requests = true;
  for (std::size_t i = 0; i < reserves.size(); ++i) {
    if (reserves[i] == nullptr) reserves[i] = std::malloc(kReserves[i]);
  }
}

/// @return whether there was something to give.
bool giveReserve() {
  for (void*& reserve : reserves) {
    if (reserve == nullptr) continue;
    std::free(reserve);
    reserve = nullptr;
    return true;
  }
  return false;
}

/// Called by C++ when an allocation has failed, which is tried again when this returns.
void onNoMemory() {
  if (!reads_requests) throw std::bad_alloc();
  if (giveReserve()) return;
  const auto now = Clock::now();
  const bool begins_to_wait = now - last_nap > 10 * kNap;
  if (begins_to_wait) {
    std::fputs("a request waits for memory\n", stderr);
    first_nap = now;
  }
  if (now - first_nap > kPatience) {
    std::fputs("there is no memory to read a request: the node ends\n", stderr);
    throw std::bad_alloc();
  }
  std::this_thread::sleep_for(kNap);
  last_nap = Clock::now();
}

}  // namespace

RequestMemory::RequestMemory()
    : at_each_poll_(ros::PollManager::instance()->addPollThreadListener(holdReserves)),
      earlier_handler_(std::set_new_handler(onNoMemory)) {}

RequestMemory::~RequestMemory() {
  ros::PollManager::instance()->removePollThreadListener(at_each_poll_);
  std::set_new_handler(earlier_handler_);
}

}  // namespace spherical_springs
