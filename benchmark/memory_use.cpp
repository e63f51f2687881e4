#include "memory_use.h"

#include <malloc.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <stdexcept>
#include <string>

namespace benchmark_scenes {
namespace {

/// An entry of /proc/self/status, which is in kB.
std::size_t status(const std::string& name) {
  std::ifstream file("/proc/self/status");
  for (std::string word; file >> word;) {
    std::size_t kilobytes;
    if (word == name + ":" && file >> kilobytes) return 1024 * kilobytes;
  }
  throw std::runtime_error("/proc/self/status has no " + name);
}

void forgetPeak() {
  std::ofstream file("/proc/self/clear_refs");
  if (!(file << 5 << std::flush)) throw std::runtime_error("cannot write /proc/self/clear_refs");
}

MemoryUse measured(const std::function<std::function<void()>()>& prepare) {
  const std::size_t before = status("VmRSS");
  const std::function<void()> work = prepare();
  malloc_trim(0);
  MemoryUse use;
  use.prepared = status("VmRSS") - before;
  forgetPeak();
  work();
  use.peak = status("VmHWM") - before;
  return use;
}

}  // namespace

MemoryUse memoryUse(const std::function<std::function<void()>()>& prepare) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("cannot make a pipe");
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("cannot make a process");
  if (child == 0) {
    try {
      const MemoryUse use = measured(prepare);
      _exit(write(ends[1], &use, sizeof use) == sizeof use ? 0 : 1);
    } catch (...) {
      _exit(1);
    }
  }
  close(ends[1]);
  MemoryUse use;
  const bool received = read(ends[0], &use, sizeof use) == sizeof use;
  close(ends[0]);
  waitpid(child, nullptr, 0);
  if (!received) throw std::runtime_error("the process that measures memory failed");
  return use;
}

}  // namespace benchmark_scenes
