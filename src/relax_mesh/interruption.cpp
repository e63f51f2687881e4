#include "relax_mesh/interruption.h"

#include <atomic>
#include <csignal>

namespace spherical_springs::relax_mesh {
namespace {

// Written by a signal handler and read by threads, which only lock-free atomics allow.
std::atomic<bool> was_interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void keep(int) {
  was_interrupted = true;
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, SIG_DFL);
}

}  // namespace

void keepInterruptions() {
  std::signal(SIGINT, keep);
  std::signal(SIGTERM, keep);
}

bool interrupted() { return was_interrupted; }

void throwIfInterrupted() {
  if (interrupted()) throw Interrupted();
}

}  // namespace spherical_springs::relax_mesh
