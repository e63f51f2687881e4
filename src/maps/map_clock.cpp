#include "maps/map_clock.h"

namespace spherical_springs::mesh {

bool MapClock::goOn() {
  const double now = elapsed();
  const bool in_time = now < options_.max_time;
  if (!options_.go_on({in_time ? now / options_.max_time : 1, spread_}) || !in_time) ended_ = true;
  last_call_ = elapsed();
  return !ended_;
}

void MapClock::check() {
  constexpr double kPause = 0.02;  // [s]
  if (std::this_thread::get_id() == thread_) {
    if (elapsed() > last_call_ + kPause) goOn();
  } else if (elapsed() > options_.max_time) {
    ended_ = true;
  }
  if (ended()) throw TimeIsOver();
}

}  // namespace spherical_springs::mesh
