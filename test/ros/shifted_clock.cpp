// To be preloaded: the wall clock as it is after somebody has set it, shifted by as many seconds as
// the file $CLOCK_SHIFT says.
#include <dlfcn.h>
#include <sys/time.h>

#include <cstdlib>
#include <ctime>
#include <fstream>

namespace {

time_t shift() {
  const char* path = std::getenv("CLOCK_SHIFT");  // NOLINT(concurrency-mt-unsafe): nobody sets it
  time_t seconds = 0;
  if (path != nullptr) std::ifstream(path) >> seconds;
  return seconds;
}

}  // namespace

// NOLINTBEGIN(readability-inconsistent-declaration-parameter-name): those of glibc are reserved

extern "C" int clock_gettime(clockid_t clock, timespec* time) noexcept {
  using Function = int (*)(clockid_t, timespec*);
  static const auto real = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "clock_gettime"));
  const int result = real(clock, time);
  if (result == 0 && clock == CLOCK_REALTIME) time->tv_sec += shift();
  return result;
}

extern "C" int gettimeofday(timeval* time, void*) noexcept {
  timespec now{};
  const int result = clock_gettime(CLOCK_REALTIME, &now);
  time->tv_sec = now.tv_sec;
  time->tv_usec = now.tv_nsec / 1000;
  return result;
}

// NOLINTEND(readability-inconsistent-declaration-parameter-name)
