#include "stepper.h"

#include <algorithm>

#include "surviving.h"

namespace spherical_springs {
namespace {

constexpr double kPeriod = 0.01;  // [s]

}  // namespace

Stepper::Stepper(const ros::NodeHandle& node, core::Runner& runner, const Parameters& parameters)
    : runner_(runner),
      pacer_(parameters.time_step, parameters.real_time_factor),
      last_tick_(ros::Time::now()),
      last_wall_tick_(ros::WallTime::now()),
      timer_(node.createTimer(ros::Duration(kPeriod), surviving([this] { tick(); }))) {}

// Steps that do not fit into the time until the next tick are dropped: simulated time falls behind.
void Stepper::tick() {
  const ros::Time now = ros::Time::now();
  const ros::WallTime wall_now = ros::WallTime::now();
  // Under use_sim_time the clock is zero until its first message; that it then begins somewhere is
  // no time gone by.
  const double elapsed = last_tick_.isZero() ? 0 : (now - last_tick_).toSec();
  const std::uint64_t due = pacer_.due(elapsed);
  const double wall_elapsed = (wall_now - last_wall_tick_).toSec();
  last_tick_ = now;
  last_wall_tick_ = wall_now;
  runner_.advance(due, std::max(kPeriod, wall_elapsed));
}

}  // namespace spherical_springs
