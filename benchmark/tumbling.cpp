// How well steps keep the energy of random scenes whose springs pass places without derivative all
// the time, and what that costs beside steps that take no notice of such places.
#include <algorithm>
#include <boost/program_options.hpp>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "spherical_springs/measures.h"
#include "stepping/blocked_splitting.h"
#include "support/tumbling_scenes.h"

namespace {

using namespace spherical_springs::core;

struct Choices {
  testing::Tumbling scene;
  std::string method;
  double time_step;  // [s]
  std::uint64_t steps;
  unsigned scenes;
  int threads;
};

/// What came of one scene.
struct Outcome {
  double energy_error = 0;  // the largest, by the first energy
  double momentum = 0;      // the sum of m omega at the end, which was 0 at first [kg m^2/s]
  double seconds = 0;       // of processor time
};

class Run {
 public:
  Run(const Scene& scene, const Choices& choices, Passing passing)
      : state_(testing::stateOf(scene)) {
    System::Options options;
    options.threads = choices.threads;
    plan_ = std::make_shared<const Plan>(scene, options);
    stepper_ = std::make_unique<BlockedSplitting>(
        plan_, splittingScheme(integrationMethod(choices.method)), choices.time_step, passing);
    stepper_->take(state_);
    first_ = total();
  }

  void advance(std::uint64_t steps) {
    const std::clock_t begin = std::clock();
    stepper_->advance(steps);
    outcome_.seconds += static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    stepper_->give(state_);
    outcome_.energy_error = std::max(outcome_.energy_error, std::abs(total() - first_) / first_);
  }

  Outcome outcome() {
    outcome_.momentum = plan_->system()->angularMomentum(state_.angular_velocities).norm();
    return outcome_;
  }

 private:
  double total() const { return energies(*plan_, state_).total() + state_.dissipated; }

  State state_;
  std::shared_ptr<const Plan> plan_;
  std::unique_ptr<BlockedSplitting> stepper_;
  double first_ = 0;
  Outcome outcome_;
};

/// Processor time of a step that takes no notice [s], while the scene is not yet beyond all bounds.
double plainStep(const Scene& scene, const Choices& choices) {
  const std::uint64_t steps = std::min<std::uint64_t>(choices.steps, 2000);
  Run run(scene, choices, Passing::ignored);
  run.advance(steps);
  return run.outcome().seconds / static_cast<double>(steps);
}

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

void measure(const Choices& choices) {
  constexpr std::uint64_t kLook = 1000;  // steps
  std::vector<double> errors, momenta, ratios, times;
  for (unsigned seed = 1; seed <= choices.scenes; ++seed) {
    const Scene scene = testing::tumblingScene(seed, choices.scene);
    Run run(scene, choices, Passing::resolved);
    for (std::uint64_t done = 0; done < choices.steps; done += kLook) {
      run.advance(std::min(kLook, choices.steps - done));
    }
    const Outcome outcome = run.outcome();
    errors.push_back(outcome.energy_error);
    momenta.push_back(outcome.momentum);
    times.push_back(outcome.seconds / static_cast<double>(choices.steps));
    ratios.push_back(times.back() / plainStep(scene, choices));
  }
  std::cout
      << "| integrator | scenes | steps | median error | worst error | momentum | us a step | "
         "times a plain step |\n| --- | --- | --- | --- | --- | --- | --- | --- |\n| `"
      << choices.method << "` | " << choices.scenes << " | " << choices.steps << " | "
      << quantile(errors, 0.5) << " | " << quantile(errors, 1) << " | " << quantile(momenta, 1)
      << " | " << 1e6 * quantile(times, 0.5) << " | " << quantile(ratios, 0.5) << " |\n";
}

}  // namespace

int main(int argc, char** argv) {
  namespace po = boost::program_options;
  Choices choices;
  po::options_description options("Options");
  const auto add = [&](const char* name, auto& value, auto standard, const char* text) {
    options.add_options()(
        name,
        po::value(&value)->default_value(static_cast<std::decay_t<decltype(value)>>(standard)),
        text);
  };
  add("integrator", choices.method, "verlet", "euler, verlet, fourth_order");
  add("time-step", choices.time_step, 0.01, "[s]");
  add("steps", choices.steps, 1000000, "of each scene");
  add("scenes", choices.scenes, 100, "how many");
  add("threads", choices.threads, 1, "");
  add("particles", choices.scene.particles, 12, "of a scene");
  add("arcs", choices.scene.arcs, 24, "angle springs");
  add("triangles", choices.scene.triangles, 12, "solid-angle springs");
  add("oriented", choices.scene.oriented, 0, "oriented angle springs");
  add("pinned", choices.scene.pinned, 0, "particles");
  add("all-masses", choices.scene.of_all_masses, false, "over four decades, in place of 1");
  options.add_options()("help", "");
  try {
    po::variables_map given;
    po::store(po::parse_command_line(argc, argv, options), given);
    po::notify(given);
    if (given.count("help") > 0) {
      std::cout << options;
      return 0;
    }
    measure(choices);
  } catch (const std::exception& fault) {
    std::cerr << fault.what() << '\n';
    return 1;
  }
  return 0;
}
