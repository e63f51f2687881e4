#include "relax_mesh/service_call.h"

#include <algorithm>
#include <chrono>
#include <future>

#include "relax_mesh/interruption.h"

namespace spherical_springs::relax_mesh {

bool waitFor(const std::function<bool()>& call, const std::function<void()>& hang_up,
             const Patience& patience) {
  using Seconds = std::chrono::duration<double>;
  constexpr std::chrono::milliseconds kBetweenLooks(20);
  constexpr Seconds kAfterInterruption(1);
  const auto now = [] { return std::chrono::steady_clock::now().time_since_epoch(); };

  Seconds deadline = now() + Seconds(patience.seconds);
  bool was_interrupted = false, has_hung_up = false;
  auto answer = std::async(std::launch::async, call);
  while (answer.wait_for(kBetweenLooks) != std::future_status::ready) {
    if (interrupted()) {
      if (!was_interrupted) deadline = std::min<Seconds>(deadline, now() + kAfterInterruption);
      was_interrupted = true;
      patience.on_interruption();
    }
    if (now() < deadline || has_hung_up) continue;
    hang_up();
    has_hung_up = true;
  }
  return answer.get();
}

}  // namespace spherical_springs::relax_mesh
