#include "node/reconfiguration.h"

#include <dynamic_reconfigure/ConfigDescription.h>

#include <optional>
#include <stdexcept>
#include <string>

#include "node/faults.h"
#include "spherical_springs/range.h"

namespace spherical_springs {
namespace {

template <class From, class To>
void copyFields(const From& from, To& to) {
  Pace::forEachField([](const char*, const auto& value, auto& copy) { copy = value; }, from, to);
}

SteppingConfig configOf(const Pace& pace) {
  SteppingConfig config = SteppingConfig::__getDefault__();
  copyFields(pace, config);
  return config;
}

/// @throw std::invalid_argument where an update names something else than the fields of `pace`.
Pace updated(const Pace& pace, dynamic_reconfigure::Config& update) {
  SteppingConfig config = configOf(pace);
  if (!config.__fromMessage__(update)) {
    std::string names;
    Pace::forEachField([&](const char* name) { names += std::string(" ") + name; });
    throw std::invalid_argument(
        "the update names a parameter twice, or one that is unknown or of another type; allowed:" +
        names);
  }
  Pace wanted = pace;
  copyFields(config, wanted);
  return wanted;
}

/// Names what changes; which time step an accuracy chooses is told by ~status.
std::string wordsFor(Pace wanted, const Pace& now) {
  const bool is_overruled = wanted.accuracy > 0 && wanted.time_step != now.time_step;
  if (!is_overruled) return wanted.differenceFrom(now);
  wanted.time_step = now.time_step;
  std::string words = wanted.differenceFrom(now);
  if (!words.empty()) words += "; ";
  return words + "~accuracy chooses ~time_step, so that it is not set";
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
      node_(node),
      pace_(pace) {
  constexpr double kCheck = 0.1;  // [s]
  constexpr bool kLatched = true;
  descriptions_ = node_.advertise<dynamic_reconfigure::ConfigDescription>("parameter_descriptions",
                                                                          1, kLatched);
  updates_ = node_.advertise<dynamic_reconfigure::Config>("parameter_updates", 1, kLatched);
  descriptions_.publish(SteppingConfig::__getDescriptionMessage__());
  show();
  service_ = node_.advertiseService("set_parameters", &Reconfiguration::reconfigure, this);
  timer_ = node_.createSteadyTimer(
      ros::WallDuration(kCheck),
      loggingFaults("dynamic_reconfigure shows changes later", [this] { showChanges(); }));
}

bool Reconfiguration::reconfigure(Service::Request& request, Service::Response& response) {
  try {
    change(request.config);
  } catch (const std::exception& fault) {
    refuse(fault);
  }
  show();
  configOf(pace_).__toMessage__(response.config);
  return true;
}

void Reconfiguration::change(dynamic_reconfigure::Config& update) {
  const Pace now = present();
  Pace wanted = updated(now, update);
  if (wanted.differenceFrom(now).empty()) return;
  wanted.requireValid();
  std::optional<bool> running;
  if (wanted.running != now.running) running = wanted.running;
  const std::string words = wordsFor(wanted, now);
  wanted.time_step = runner_.stepBy(wanted.stepWish(), running).time_step;
  apply(wanted);
  news_.tell(words, "reconfigured: ");
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
  shown_ = false;
}

void Reconfiguration::refuse(const std::exception& fault) noexcept {
  const char* reason = reasonOf(fault);
  if (dynamic_cast<const core::NonFinite*>(&fault) != nullptr) news_.refused(reason);
  news_.tell(reason, "not reconfigured: ");
  logFault("not reconfigured", reason);
}

/// Returns the parameters that hold now.
Pace Reconfiguration::present() const {
  Pace now = pace_;
  now.running = runner_.isRunning();
  if (now.accuracy > 0) {
    now.time_step =
        runner_.read([](const core::Simulation& s) { return s.lastChoice().time_step; });
  }
  return now;
}

void Reconfiguration::showChanges() {
  if (!shown_ || !present().differenceFrom(pace_).empty()) show();
}

void Reconfiguration::show() {
  const Pace now = present();
  const SteppingConfig config = configOf(now);
  config.__toServer__(node_);
  dynamic_reconfigure::Config message;
  config.__toMessage__(message);
  updates_.publish(message);
  pace_ = now;
  shown_ = true;
}

}  // namespace spherical_springs
