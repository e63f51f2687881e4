// Processor time against error, for several scenes, every integrator and a range of steps, beside
// the report transcribed; and largest torque against time for both ways of relaxing. Two CSV files.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <functional>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "spherical_springs/integrator.h"
#include "spherical_springs/measures.h"
#include "spherical_springs/relaxation.h"
#include "support/scenes.h"
#include "transcription/report.h"
#include "work_scenes.h"

namespace {

using namespace spherical_springs::core;  // NOLINT: a program, not a header
using benchmark_scenes::WorkScene;
using testing::stateOf;

/// Processor time [s], which other programs take no part of; all runs have one thread.
double now() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

// --- stepping ---

struct Outcome {
  Points positions;
  double energy_error;  // relative to the energy at the start; 0 where it is not kept
  double taken;         // [s]
};

Outcome stepped(const WorkScene& c, IntegrationMethod method, double time_step, int steps) {
  const auto plan = std::make_shared<const Plan>(c.scene, System::Options());
  State state = stateOf(c.scene);
  const double before = energies(*plan, state).total();
  const auto integrator = makeIntegrator(plan, method, time_step);
  const double begin = now();
  for (int i = 0; i < steps; ++i) integrator->step(state);
  const double taken = now() - begin;
  const double after = energies(*plan, state).total() + state.dissipated;
  return {state.positions, std::abs(after - before) / before, taken};
}

/// The report has no damping of whole springs; its scenes here have none.
bool isTranscribable(const WorkScene& c) {
  const auto& arcs = c.scene.springs<AngleSpring>().items();
  return std::none_of(arcs.begin(), arcs.end(),
                      [](const AngleSpring& spring) { return spring.damping > 0; });
}

Outcome transcribed(const WorkScene& c, double time_step, int steps) {
  report::Scene plain;
  for (const Particle& p : c.scene.particles().items()) {
    const Vector3& at = p.position;
    plain.particles.push_back({{at.x(), at.y(), at.z()}, {}, p.mass, p.damping});
  }
  for (const AngleSpring& s : c.scene.springs<AngleSpring>().items()) {
    plain.angle_springs.push_back(
        {{int(s.particles[0]), int(s.particles[1])}, s.rest_angle, s.stiffness});
  }
  for (const SolidAngleSpring& s : c.scene.springs<SolidAngleSpring>().items()) {
    const auto [i, j, k] = s.particles;
    plain.solid_angle_springs.push_back(
        {{int(i), int(j), int(k)}, s.rest_solid_angle, s.stiffness});
  }
  const double begin = now();
  for (int i = 0; i < steps; ++i) report::step(plain, time_step);
  Outcome outcome{Points(3, plain.particles.size()), 0, now() - begin};
  for (std::size_t i = 0; i < plain.particles.size(); ++i) {
    const report::Vector& p = plain.particles[i].position;
    outcome.positions.col(i) = Vector3(p.x, p.y, p.z);
  }
  return outcome;
}

Outcome medianOfThree(const std::function<Outcome()>& run) {
  std::vector<Outcome> outcomes = {run(), run(), run()};
  std::sort(outcomes.begin(), outcomes.end(),
            [](const Outcome& a, const Outcome& b) { return a.taken < b.taken; });
  return outcomes[1];
}

double distance(const Points& a, const Points& b) { return (a - b).colwise().norm().maxCoeff(); }

void measureSteps(const WorkScene& c, double budget, std::ostream& csv) {
  const auto system = std::make_shared<const System>(c.scene, System::Options());
  const double stable =
      stableTimeStep(*system, IntegrationMethod::verlet, stateOf(c.scene).positions);
  const int first = std::max(1, int(std::ceil(c.duration / (0.5 * stable))));

  const int reference_steps = 64 * first;
  const auto referenceWith = [&](int steps) {
    return stepped(c, IntegrationMethod::fourth_order, c.duration / steps, steps).positions;
  };
  const Points reference = c.solution ? c.solution(c.duration) : referenceWith(2 * reference_steps);
  const double reference_error = distance(reference, referenceWith(reference_steps));
  csv << c.name << ",reference," << c.duration / reference_steps << ",," << reference_error
      << ",\n";

  const auto sweep = [&](const std::string& name, const std::function<Outcome(double, int)>& run) {
    for (int steps = first; steps <= 4096 * first; steps *= 2) {
      const Outcome outcome = medianOfThree([&] { return run(c.duration / steps, steps); });
      csv << c.name << "," << name << "," << c.duration / steps << "," << outcome.taken / c.duration
          << "," << distance(outcome.positions, reference) << "," << outcome.energy_error << "\n";
      if (outcome.taken > budget) break;
    }
  };
  for (const char* name : {"euler", "verlet", "fourth_order", "implicit_euler"}) {
    sweep(name, [&](double time_step, int steps) {
      return stepped(c, integrationMethod(name), time_step, steps);
    });
  }
  if (isTranscribable(c)) {
    sweep("report", [&](double time_step, int steps) { return transcribed(c, time_step, steps); });
  }
}

// --- relaxing ---

void measureRelaxation(std::ostream& csv) {
  const Scene scene = benchmark_scenes::mesh(0);
  const System system(scene, System::Options());
  for (const char* name : {"newton", "dynamics", "fire"}) {
    RelaxationOptions options;
    options.method = relaxationMethod(name);
    options.tolerance = 1e-12;
    const double begin = now();
    options.go_on = [&](const RelaxationProgress& progress) {
      csv << name << "," << now() - begin << "," << progress.best.max_torque << "\n";
      return true;
    };
    const auto result = relax(system, stateOf(scene).positions, options);
    csv << name << "," << now() - begin << "," << result.max_torque << "\n";
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3 && argc != 4) {
    std::cerr << "usage: work_precision STEPS.csv RELAXATION.csv [SECONDS_A_RUN]\n";
    return 1;
  }
  const double budget = argc == 4 ? std::atof(argv[3]) : 1;
  std::ofstream steps(argv[1]);
  steps << "scene,method,time_step,time_per_second,trajectory_error,energy_error\n";
  for (const WorkScene& c : benchmark_scenes::workScenes()) {
    std::cout << c.name << std::endl;
    measureSteps(c, budget, steps);
  }
  std::ofstream relaxation(argv[2]);
  relaxation << "method,time,max_torque\n";
  std::cout << "relaxation" << std::endl;
  measureRelaxation(relaxation);
  return steps && relaxation ? 0 : 1;
}
