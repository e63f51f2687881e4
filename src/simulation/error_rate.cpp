#include "simulation/error_rate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "stepping/stability.h"

namespace spherical_springs::core {
namespace {

constexpr double kWindow = 16;  // by the fastest time: 3 to 5 periods
constexpr int kFewestSteps = 4;

double highestSpeed(const State& state) {
  if (state.positions.cols() == 0) return 0;
  return state.angular_velocities.colwise().norm().maxCoeff();
}

}  // namespace

ErrorProbe::ErrorProbe(std::shared_ptr<const Plan> plan, const State& state, int most_steps)
    : plan_(std::move(plan)),
      state_(state),
      most_steps_(most_steps),
      highest_frequency_(highestFrequency(*plan_->system(), state.positions)),
      highest_speed_(highestSpeed(state)) {}

double ErrorProbe::fastestTime() const { return 2 / std::max(highest_frequency_, highest_speed_); }

double ErrorProbe::stableTimeStep(IntegrationMethod method) const {
  return stabilityLimit(method) / highest_frequency_;
}

int ErrorProbe::stepsTried(double time_step) const {
  const double steps = std::ceil(kWindow * fastestTime() / time_step);
  return static_cast<int>(std::clamp<double>(steps, kFewestSteps, most_steps_));
}

double ErrorProbe::errorRate(IntegrationMethod method, double time_step) const {
  if (!std::isfinite(fastestTime())) return 0;
  const double tried = std::max(time_step, kWindow * fastestTime() / most_steps_);
  const int steps = stepsTried(tried);
  const int order = orderOf(method);
  const double error = largestDifference(method, tried, steps) / (1 - std::pow(2., -order));
  return error / (steps * tried) * std::pow(time_step / tried, order);
}

double ErrorProbe::largestDifference(IntegrationMethod method, double time_step, int steps) const {
  constexpr int kInstants = 32;
  const auto whole = makeIntegrator(plan_, method, time_step);
  const auto half = makeIntegrator(plan_, method, time_step / 2);
  whole->take(state_);
  half->take(state_);
  State by_whole = state_, by_half = state_;
  const int stride = (steps + kInstants - 1) / kInstants;
  double largest = 0;
  for (int done = 0; done < steps; done += stride) {
    whole->advance(std::min(stride, steps - done));
    half->advance(2 * std::min(stride, steps - done));
    whole->give(by_whole);
    half->give(by_half);
    const double distance = (by_whole.positions - by_half.positions).colwise().norm().maxCoeff();
    if (!std::isfinite(distance)) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, distance);
  }
  return largest;
}

}  // namespace spherical_springs::core
