#include "simulation/step_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "base/rounded.h"
#include "simulation/error_rate.h"
#include "stepping/splitting.h"

namespace spherical_springs::core {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kMostTried = 1024;
// Shares of the accuracy: the error that a choice aims at, and the largest that a review keeps.
constexpr double kAim = 0.7, kLessExact = 1.5;
// Shares of the stable step, which changes as particles move: the longest step that is chosen, and
// that a review keeps.
constexpr double kShareOfStable = 0.75, kKeptShareOfStable = 0.9;
constexpr double kLongest = 4;       // by the fastest time, for methods that bear any step
constexpr double kShortest = 1e-6;   // by the fastest time
constexpr double kRounding = 1e-14;  // error by the fastest time [rad]
// Windows between reviews, which try three times the steps of one: less than 5 % of the work.
constexpr int kReviewAfter = 64;

struct Candidate {
  IntegrationMethod method;
  double time_step;   // [s]
  double error_rate;  // [rad/s]
};

class Chooser {
 public:
  Chooser(const std::shared_ptr<const Plan>& plan, const StepWish& wish, const State& state)
      : wish_(wish),
        probe_(plan, state, kMostTried),
        floor_(kRounding / probe_.fastestTime()),
        accuracy_(std::max(wish.accuracy, floor_)) {}

  StepChoice chosen() const {
    if (!std::isfinite(probe_.fastestTime())) return choiceOf({wish_.method, wish_.time_step, 0});
    if (!wish_.chooses_method) return choiceOf(*longest(wish_.method));
    const Candidate exact = *longest(IntegrationMethod::fourth_order);
    const auto quick = longest(IntegrationMethod::verlet, workOf(exact.method, exact.time_step));
    return choiceOf(quick && (isExact(*quick) || !isExact(exact)) ? *quick : exact);
  }

  StepChoice reviewed(const StepChoice& present) const {
    const Candidate now = tried(present.method, present.time_step);
    return isKept(now) ? choiceOf(now) : chosen();
  }

 private:
  /// Evaluations of all forces a second, by a method that `wish_` may leave to be chosen.
  static double workOf(IntegrationMethod method, double time_step) {
    return static_cast<double>(splittingScheme(method).kick.size()) / time_step;
  }

  Candidate tried(IntegrationMethod method, double time_step) const {
    return {method, time_step, probe_.errorRate(method, time_step)};
  }

  bool isExact(const Candidate& candidate) const { return candidate.error_rate <= accuracy_; }

  double longestStep(IntegrationMethod method) const {
    return std::min({kShareOfStable * probe_.stableTimeStep(method),
                     kLongest * probe_.fastestTime(), StepWish::kLongest});
  }

  double shortestStep() const {
    return std::max(kShortest * probe_.fastestTime(), StepWish::kShortest);
  }

  /// Returns the step at which the error would be what is aimed at, if it went with the order.
  double betterStep(const Candidate& last) const {
    constexpr double kLeastFactor = 0.01;  // as the order does not hold for steps that are too long
    const double factor = std::pow(kAim * accuracy_ / last.error_rate, 1. / orderOf(last.method));
    const double step = last.time_step * std::max(factor, kLeastFactor);
    return std::min(std::max(step, shortestStep()), longestStep(last.method));
  }

  /// Returns the longest step of a method that is exact, or the shortest one that was tried;
  /// nothing where that would take more than `most_work`.
  std::optional<Candidate> longest(IntegrationMethod method, double most_work = kInfinity) const {
    constexpr int kMostTries = 10;
    constexpr double kNear = 1.25;
    std::optional<Candidate> exact, inexact;  // the longest and the shortest so far
    double step = longestStep(method);
    for (int tries = 0; tries < kMostTries; ++tries) {
      if (most_work < kInfinity && workOf(method, step) > most_work) return {};
      const Candidate last = tried(method, step);
      (isExact(last) ? exact : inexact) = last;
      step = betterStep(last);
      if (exact && inexact) {
        if (inexact->time_step < kNear * exact->time_step) break;
        // The error of fourth_order jumps where damping decays within a step.
        const bool is_between = exact->time_step < step && step < inexact->time_step;
        if (!is_between) step = std::sqrt(exact->time_step * inexact->time_step);
      }
      if (isExact(last) ? step < kNear * last.time_step : step == last.time_step) break;
    }
    return exact ? exact : inexact;
  }

  /// Whether steps go on as they are: not much less exact than they should be, nor much shorter.
  bool isKept(const Candidate& now) const {
    constexpr double kShorter = 1.5;
    return now.error_rate <= kLessExact * accuracy_ &&
           now.time_step <= kKeptShareOfStable * probe_.stableTimeStep(now.method) &&
           betterStep(now) <= kShorter * now.time_step;
  }

  StepChoice choiceOf(const Candidate& chosen) const {
    StepChoice choice{chosen.method, chosen.time_step, std::max(chosen.error_rate, floor_)};
    choice.is_reached = choice.error_rate <= kLessExact * wish_.accuracy;
    choice.steps_to_review = kReviewAfter * probe_.stepsTried(chosen.time_step);
    return choice;
  }

  const StepWish& wish_;
  const ErrorProbe probe_;
  const double floor_;     // that rounding sets to the error [rad/s]
  const double accuracy_;  // that can be asked for [rad/s]
};

}  // namespace

StepChoice chooseSteps(const std::shared_ptr<const Plan>& plan, const StepWish& wish,
                       const State& state) {
  return Chooser(plan, wish, state).chosen();
}

StepChoice reviewedSteps(const std::shared_ptr<const Plan>& plan, const StepWish& wish,
                         const State& state, const StepChoice& present) {
  return Chooser(plan, wish, state).reviewed(present);
}

std::string inWords(const StepChoice& choice, double accuracy) {
  const std::string steps = std::string("steps of ") + nameOf(choice.method) + ", " +
                            roundedText(choice.time_step) + " s long, ";
  const std::string error = roundedText(choice.error_rate) + " rad/s";
  if (choice.is_reached) return "chose " + steps + "for an error of " + error;
  return "an accuracy of " + toText(accuracy) + " rad/s is out of reach here: " + steps +
         "the most exact ones, have an error of " + error;
}

}  // namespace spherical_springs::core
