// Errors asked for against errors got, and their cost against that of the best fixed step, for
// several scenes. Prints a table and writes it as CSV.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <iostream>
#include <limits>
#include <memory>
#include <vector>

#include "spherical_springs/measures.h"
#include "spherical_springs/simulation.h"
#include "stepping/splitting.h"
#include "support/scenes.h"
#include "work_scenes.h"

namespace {

using namespace spherical_springs::core;  // NOLINT: a program, not a header
using benchmark_scenes::WorkScene;

constexpr double kAsked[] = {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9};  // [rad/s]

/// A scene, and steps of it so small that they count as exact.
class Exact {
 public:
  explicit Exact(const WorkScene& scene)
      : name(scene.name),
        duration(scene.duration),
        plan(std::make_shared<const Plan>(scene.scene, System::Options())),
        start(testing::stateOf(scene.scene)),
        stable(stableTimeStep(*plan->system(), IntegrationMethod::verlet, start.positions)),
        step_(stable / (scene.name == "tumbling" ? 1024 : 128)) {}

  /// Steps of some length, and a run of them.
  struct Run {
    double error_rate;       ///< largest distance over particles and instants, by the time [rad/s]
    double reference_error;  ///< the same of exact steps, by those of twice their length [rad/s]
  };

  Run run(IntegrationMethod method, double time_step) const {
    const int stride = std::max(1, static_cast<int>(stable / 32 / time_step));
    const int fewest = method == IntegrationMethod::fourth_order ? 8 * stride : 2;
    const int substeps = std::max(fewest, 2 * static_cast<int>(stride * time_step / step_ / 2));
    const double period = stride * time_step;
    const auto tested = makeIntegrator(plan, method, time_step);
    const auto exact = makeIntegrator(plan, IntegrationMethod::fourth_order, period / substeps);
    const auto check = makeIntegrator(plan, IntegrationMethod::fourth_order, 2 * period / substeps);
    for (const auto& integrator : {tested.get(), exact.get(), check.get()}) integrator->take(start);
    const int periods = std::max(1, static_cast<int>(std::lround(duration / period)));
    Run result{0, 0};
    State by_tested = start, by_exact = start, by_check = start;
    for (int i = 0; i < periods; ++i) {
      tested->advance(stride);
      exact->advance(substeps);
      check->advance(substeps / 2);
      tested->give(by_tested);
      exact->give(by_exact);
      check->give(by_check);
      result.error_rate = std::max(result.error_rate, distance(by_tested, by_exact));
      result.reference_error = std::max(result.reference_error, distance(by_check, by_exact));
    }
    result.error_rate /= periods * period;
    result.reference_error /= periods * period;
    return result;
  }

  const std::string name;
  const double duration;  // [s]
  const std::shared_ptr<const Plan> plan;
  const State start;
  const double stable;  // for verlet [s]

 private:
  static double distance(const State& a, const State& b) {
    return (a.positions - b.positions).colwise().norm().maxCoeff();
  }

  const double step_;  // [s]
};

/// Evaluations of all forces in a simulated second.
double workOf(IntegrationMethod method, double time_step) {
  return static_cast<double>(splittingScheme(method).kick.size()) / time_step;
}

/// Fixed steps of one method, from long to short.
class FixedSteps {
 public:
  FixedSteps(const Exact& exact, IntegrationMethod method) {
    const double longest = 0.9 * exact.stable * stabilityLimit(method) / 2;
    for (double step = longest; step > exact.stable / 4000; step /= std::sqrt(2)) {
      points_.push_back({workOf(method, step), exact.run(method, step).error_rate});
      if (points_.back().error_rate < kAsked[6] / 10) break;
    }
  }

  /// The least work for an error [rad/s], between the steps that were measured.
  double workFor(double error_rate) const {
    if (points_[0].error_rate <= error_rate) return points_[0].work;
    for (std::size_t i = 1; i < points_.size(); ++i) {
      const Point &a = points_[i - 1], &b = points_[i];
      if (b.error_rate > error_rate) continue;
      const double share =
          std::log(a.error_rate / error_rate) / std::log(a.error_rate / b.error_rate);
      return a.work * std::pow(b.work / a.work, share);
    }
    return std::numeric_limits<double>::infinity();
  }

 private:
  struct Point {
    double work, error_rate;
  };
  std::vector<Point> points_;
};

double processorTime() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

void measure(const WorkScene& scene, std::ostream& csv) {
  const Exact exact(scene);
  const FixedSteps by_verlet(exact, IntegrationMethod::verlet);
  const FixedSteps by_fourth_order(exact, IntegrationMethod::fourth_order);
  for (const double asked : kAsked) {
    Simulation::Settings settings;
    settings.accuracy = asked;
    settings.chooses_method = true;
    Simulation simulation(settings);
    simulation.load({scene.scene, 0});
    const double begin = processorTime();
    const StepChoice choice = simulation.choice();
    const double choosing = processorTime() - begin;
    constexpr int kSteps = 300;
    const double first_step = processorTime();
    simulation.step(kSteps);
    const double step_time = (processorTime() - first_step) / kSteps;

    const Exact::Run got = exact.run(choice.method, choice.time_step);
    const double work = workOf(choice.method, choice.time_step);
    const auto best = [&](double error) {
      return std::min(by_verlet.workFor(error), by_fourth_order.workFor(error));
    };
    const double stable = exact.stable * stabilityLimit(choice.method) / 2;
    std::printf("| %s | %.0e | %.1e | `%s` | %.2g | %.2f | %.2f | %.2f | %.0f |\n",
                exact.name.c_str(), asked, got.error_rate, nameOf(choice.method), choice.time_step,
                choice.time_step / stable, work / best(got.error_rate), work / best(asked),
                choosing / step_time);
    std::fflush(stdout);
    csv << exact.name << ',' << asked << ',' << got.error_rate << ',' << nameOf(choice.method)
        << ',' << choice.time_step << ',' << choice.time_step / stable << ','
        << work / best(got.error_rate) << ',' << work / best(asked) << ',' << choosing / step_time
        << ',' << got.reference_error << '\n';
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: accuracy_benchmark TABLE.csv\n";
    return 1;
  }
  std::ofstream csv(argv[1]);
  csv << "scene,asked,got,integrator,time_step,share_of_stable,cost,cost_for_asked,choosing,"
         "reference\n";
  std::cout
      << "| scene | asked [rad/s] | got [rad/s] | integrator | step [s] | share of the stable "
         "step | work by that of the best fixed step for the error got | for that asked | "
         "choosing [steps] |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n"
      << std::flush;
  for (const WorkScene& scene : benchmark_scenes::workScenes()) measure(scene, csv);
  return csv ? 0 : 1;
}
