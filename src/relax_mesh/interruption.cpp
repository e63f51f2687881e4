#include "interruption.h"

#include <csignal>
#include <stdexcept>

namespace spherical_springs::relax_mesh {
namespace {

volatile std::sig_atomic_t signals = 0;

void keep(int signal) {
  signals = 1;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void keepInterruptions() {
  std::signal(SIGINT, keep);
  std::signal(SIGTERM, keep);
}

bool interrupted() { return signals != 0; }

void throwIfInterrupted() {
  if (interrupted()) throw std::runtime_error("interrupted; no file has been written");
}

}  // namespace spherical_springs::relax_mesh
