#include "node/publisher.h"

#include <algorithm>

#include "node/conversion.h"
#include "node/faults.h"
#include "node/kinds.h"
#include "node/poses.h"
#include "simulation/step_choice.h"
#include "spherical_springs/measures.h"

namespace spherical_springs {
namespace {

const char* nameOf(const core::Runner::Snapshot& snapshot) {
  if (snapshot.activity == core::Activity::relaxing) return "relaxing";
  return snapshot.running || snapshot.activity == core::Activity::stepping ? "running" : "paused";
}

/// A warning stands for as long as its cause, but hides nothing new.
std::string messageOf(const Report& report) {
  std::string warning = report.waits_for_clock ? kWaitsForClock : "";
  if (!report.warning.empty()) warning += (warning.empty() ? "" : "; ") + report.warning;
  if (warning.empty()) return report.news.message;
  return report.news.message_is_new ? report.news.message + "; " + warning : warning;
}

}  // namespace

// Samples follow the clock of ROS, as stepping does. The status follows a clock that never stands,
// nor goes back when somebody sets the time; so does a sample after a change, which the clock of
// ROS has not brought.
Publisher::Publisher(ros::NodeHandle sampling, ros::NodeHandle reporting, core::Runner& runner,
                     News& news, const Parameters& parameters)
    : parameters_(parameters),
      runner_(runner),
      news_(news),
      expected_factor_(parameters.real_time_factor),
      sample_period_(1 / parameters.publish_rate),
      diagnostics_(reporting),
      real_time_monitor_(parameters.real_time_factor, parameters.time_step) {
  const ros::WallDuration kCheck(0.05);  // [s]
  const auto on_listener = [this](const ros::SingleSubscriberPublisher&) { news_.statusChanged(); };
  poses_ = sampling.advertise<geometry_msgs::PoseArray>("poses", 1);
  energies_ = sampling.advertise<Energies>("energies", 100);
  status_ = reporting.advertise<Status>("status", 10, on_listener, ros::SubscriberStatusCallback(),
                                        ros::VoidConstPtr(), true);
  sample_timer_ = sampling.createTimer(
      ros::Duration(1 / parameters_.publish_rate),
      loggingFaults("a sample of ~poses and ~energies is left out", [this] { publishSample(); }));
  missing_sample_timer_ = sampling.createSteadyTimer(
      kCheck,
      loggingFaults("a sample after a change comes later", [this] { publishSampleIfMissing(); }));
  status_timer_ = reporting.createSteadyTimer(
      kCheck, loggingFaults("~status comes later", [this] { publishStatusIfDue(); }));
}

void Publisher::setRate(double rate) {
  sample_period_ = 1 / rate;
  sample_timer_.setPeriod(ros::Duration(1 / rate));
}

void Publisher::publishSample() {
  const bool to_poses = poses_.getNumSubscribers() > 0;
  const bool to_energies = energies_.getNumSubscribers() > 0;
  if (!to_poses && !to_energies) return;
  const std::uint64_t changes = news_.sceneChanges();
  const auto snapshot = runner_.snapshot();
  const ros::Time stamp = ros::Time::now();
  if (to_poses) {
    Poses message = {{}, snapshot.state.positions, parameters_.radius};
    message.header.stamp = stamp;
    message.header.frame_id = parameters_.frame_id;
    poses_.publish(message);
  }
  if (to_energies) {
    Energies message = energiesOf(snapshot, parameters_.frame_id);
    message.header.stamp = stamp;
    energies_.publish(message);
  }
  sampled_changes_ = changes;
  last_sample_ = Clock::now();
}

void Publisher::publishSampleIfMissing() {
  const std::chrono::duration<double> since_last = Clock::now() - last_sample_;
  if (sampled_changes_ == news_.sceneChanges() || since_last.count() < sample_period_) return;
  publishSample();
}

void Publisher::publishStatusIfDue() {
  constexpr std::chrono::seconds kPeriod(1);
  if (!rest_.isOver()) return;
  const bool listened_to = status_.getNumSubscribers() > 0 || diagnostics_.listenedTo();
  const bool due = listened_to && Clock::now() - last_status_ >= kPeriod;
  if (!news_.takeStatusChange() && !due) return;
  const Rest::Work work(rest_);
  try {
    runner_.choice();  // what is told is how the next step is done
    const auto snapshot = runner_.snapshot();
    tellOfChoice(snapshot);
    const Report now = report(snapshot);
    status_.publish(now.status);
    if (diagnostics_.listenedTo()) diagnostics_.publish(now);
  } catch (...) {
    news_.statusChanged();  // to be told yet
    throw;
  }
}

/// Tells how steps are done for an accuracy, once they are done otherwise than before: after other
/// news, but in the place of what was told of the last choice.
void Publisher::tellOfChoice(const core::Runner::Snapshot& snapshot) {
  const core::StepChoice& choice = snapshot.choice;
  const bool is_told = snapshot.accuracy == told_accuracy_ && choice.method == told_.method &&
                       choice.time_step == told_.time_step;
  if (!is_told && snapshot.accuracy > 0) {
    const News::Facts facts = news_.facts();
    std::string news = facts.message_is_new ? facts.message : "";
    if (!told_words_.empty()) news.resize(std::min(news.size(), news.find(told_words_)));
    told_words_ = (news.empty() ? "" : "; ") + core::inWords(choice, snapshot.accuracy);
    news_.tell(told_words_, news);
  }
  told_ = choice;
  told_accuracy_ = snapshot.accuracy;
}

/// The time of the steps since the last call, as a share of the wall's.
double Publisher::realTimeFactor(double stepped_time) {
  const auto now = Clock::now();
  const double elapsed = std::chrono::duration<double>(now - last_status_).count();
  last_status_ = now;
  const double simulated = stepped_time - last_stepped_time_;
  last_stepped_time_ = stepped_time;
  return elapsed > 0 ? simulated / elapsed : 0;
}

Report Publisher::report(const core::Runner::Snapshot& snapshot) {
  const core::State& state = snapshot.state;
  const core::System& system = *snapshot.plan->system();
  Report report;
  Status& message = report.status;
  message.header.stamp = ros::Time::now();
  message.header.frame_id = parameters_.frame_id;
  message.time = state.time;
  message.steps = state.steps;
  message.particles = system.particleCount();
  forEachKindInMessages([&](auto kind) {
    kind.count(message) = system.springs<typename decltype(kind)::Spring>().size();
  });
  message.state = nameOf(snapshot);
  message.integrator = core::nameOf(snapshot.choice.method);
  message.time_step = snapshot.choice.time_step;
  const double factor = realTimeFactor(snapshot.stepped_time);
  message.real_time_factor = message.state == "running" ? factor : 0;
  message.step_wall_time = snapshot.step_wall_time;
  message.relax_progress = snapshot.relax_progress;

  // Trial steps would take the processors from a relaxation, and mean nothing meanwhile.
  if (snapshot.activity != core::Activity::relaxing) {
    measures_ = core::measure(snapshot.plan, snapshot.choice.method, snapshot.choice.time_step,
                              state, *snapshot.account);
  }
  core::Measures measures = measures_;
  measures.max_torque = core::maxTorque(*snapshot.plan, state);
  message.stable_time_step = std::min(core::StepWish::kLongest, measures.stable_time_step);
  message.local_error = measures.local_error;
  message.error_rate = measures.error_rate;
  message.energy_error = measures.energy_error;
  message.angular_momentum_error = measures.angular_momentum_error;
  message.norm_error = measures.norm_error;
  message.divided_steps = measures.divided_steps;
  message.shortest_substep = measures.shortest_substep;
  message.max_torque = measures.max_torque;
  report.warning = measures.warning;
  if (report.warning.empty() && !snapshot.choice.is_reached) {
    report.warning = core::inWords(snapshot.choice, snapshot.accuracy);
  }
  report.blown_up = measures.blown_up;
  real_time_monitor_.expect(expected_factor_, snapshot.choice.time_step);
  report.behind = real_time_monitor_.behind(message.state == "running", ros::Time::now().toSec(),
                                            snapshot.stepped_time);
  report.waits_for_clock = ros::Time::isSimTime() && ros::Time::now().isZero();
  report.news = news_.facts();
  message.message = messageOf(report);
  return report;
}

}  // namespace spherical_springs
