#include "node/reconfiguration.h"

#include <optional>
#include <string>

#include "node/faults.h"
#include "spherical_springs/range.h"

namespace spherical_springs {
namespace {

template <class From, class To>
void copyFields(const From& from, To& to) {
  Pace::forEachField([](const char*, const auto& value, auto& copy) { copy = value; }, from, to);
}

}  // namespace

Reconfiguration::Reconfiguration(const ros::NodeHandle& node, core::Runner& runner, News& news,
                                 Stepper& stepper, Publisher& publisher, MarkerPublisher& markers,
                                 const Pace& pace)
    : runner_(runner),
      news_(news),
      stepper_(stepper),
      publisher_(publisher),
      markers_(markers),
      pace_(pace),
      server_(mutex_, node) {
  constexpr double kRunningCheck = 0.1;  // [s]
  server_.setCallback([this](SteppingConfig& config, std::uint32_t) { reconfigure(config); });
  timer_ = node.createWallTimer(
      ros::WallDuration(kRunningCheck),
      loggingFaults("dynamic_reconfigure shows ~running later", [this] { showRunning(); }));
}

// The server takes for the new configuration what this leaves in `config`, even where it throws.
void Reconfiguration::reconfigure(SteppingConfig& config) noexcept {
  try {
    change(config);
  } catch (const std::exception& fault) {
    refuse(fault);
  }
  pace_.running = runner_.isRunning();
  copyFields(pace_, config);
}

// An update names some parameters; the server fills in the others from what it has shown. What is
// as shown is therefore left as it is, be it that ~set_running has changed it since.
void Reconfiguration::change(const SteppingConfig& asked) {
  Pace wanted = pace_;
  copyFields(asked, wanted);
  const std::string difference = wanted.differenceFrom(pace_);
  if (difference.empty()) return;
  wanted.requireValid();
  const auto running =
      wanted.running == pace_.running ? std::nullopt : std::optional(wanted.running);
  runner_.stepBy(core::integrationMethod(wanted.integrator), wanted.time_step, running);
  apply(wanted);
  news_.tell(difference, "reconfigured: ");
}

// Nothing here fails: the runner has the new values by now.
void Reconfiguration::apply(const Pace& pace) {
  stepper_.setPace(pace);
  publisher_.expectRealTimeFactor(pace.real_time_factor);
  if (pace.publish_rate != pace_.publish_rate) {
    publisher_.setRate(pace.publish_rate);
    markers_.setRate(pace.publish_rate);
  }
  pace_ = pace;
}

void Reconfiguration::refuse(const std::exception& fault) noexcept {
  const char* reason = reasonOf(fault);
  if (dynamic_cast<const core::NonFinite*>(&fault) != nullptr) news_.refused(reason);
  news_.tell(reason, "not reconfigured: ");
  logFault("not reconfigured", reason);
}

void Reconfiguration::showRunning() {
  const bool running = runner_.isRunning();
  if (running == pace_.running) return;
  Pace pace = pace_;
  pace.running = running;
  SteppingConfig config = SteppingConfig::__getDefault__();
  copyFields(pace, config);
  server_.updateConfig(config);
  pace_ = pace;
}

}  // namespace spherical_springs
