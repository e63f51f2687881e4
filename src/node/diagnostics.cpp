#include "node/diagnostics.h"

#include <diagnostic_msgs/DiagnosticArray.h>

#include "node/kinds.h"

namespace spherical_springs {

using diagnostic_msgs::DiagnosticStatus;

Diagnostics::Diagnostics(ros::NodeHandle node)
    : listeners_(node.advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", 1)) {
  updater_.setHardwareID("none");
  updater_.add("Simulation", this, &Diagnostics::fill);
}

void Diagnostics::publish(const Report& report) {
  report_ = &report;
  updater_.force_update();
}

void Diagnostics::fill(diagnostic_updater::DiagnosticStatusWrapper& wrapper) {
  const Status& status = report_->status;
  const News::Facts& news = report_->news;
  wrapper.summary(DiagnosticStatus::OK, status.state);
  if (report_->blown_up) {
    wrapper.mergeSummary(DiagnosticStatus::ERROR, "blown up: " + report_->warning);
  } else if (!report_->warning.empty()) {
    wrapper.mergeSummary(DiagnosticStatus::WARN, report_->warning);
  }
  if (!news.refusal.empty()) {
    wrapper.mergeSummary(DiagnosticStatus::ERROR, "refused: " + news.refusal);
  }
  if (report_->waits_for_clock) wrapper.mergeSummary(DiagnosticStatus::WARN, kWaitsForClock);
  if (report_->behind) {
    wrapper.mergeSummary(DiagnosticStatus::WARN, "simulated time falls behind the clock");
  }
  if (!news.relaxation_fault.empty()) {
    wrapper.mergeSummary(DiagnosticStatus::WARN, "not converged: " + news.relaxation_fault);
  }

  wrapper.add("time [s]", status.time);
  wrapper.add("steps", status.steps);
  wrapper.add("particles", status.particles);
  forEachKindInMessages([&](auto kind) {
    wrapper.add(std::string(decltype(kind)::Spring::kName) + "s", kind.count(status));
  });
  wrapper.add("state", status.state);
  wrapper.add("integrator", status.integrator);
  wrapper.add("time step [s]", status.time_step);
  wrapper.add("stable time step [s]", status.stable_time_step);
  wrapper.add("real-time factor", status.real_time_factor);
  wrapper.add("wall time of a step [s]", status.step_wall_time);
  wrapper.add("local error [rad]", status.local_error);
  wrapper.add("error rate [rad/s]", status.error_rate);
  wrapper.add("energy error", status.energy_error);
  wrapper.add("angular momentum error", status.angular_momentum_error);
  wrapper.add("norm error", status.norm_error);
  wrapper.add("divided steps", status.divided_steps);
  wrapper.add("shortest substep [s]", status.shortest_substep);
  wrapper.add("largest torque [N m]", status.max_torque);
  wrapper.add("progress of relaxation", status.relax_progress);
  wrapper.add("requests refused for numbers that are not finite", news.refusals);
  wrapper.add("message", status.message);
}

}  // namespace spherical_springs
