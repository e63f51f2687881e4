// Wall time against error, for several scenes, every integrator and a range of steps, beside the
// report transcribed; and largest torque against time for both ways of relaxing. Two CSV files.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "meshes.h"
#include "spherical_springs/integrator.h"
#include "spherical_springs/measures.h"
#include "spherical_springs/relaxation.h"
#include "support/tumbling_scenes.h"
#include "transcription/report.h"

namespace {

using namespace spherical_springs::core;  // NOLINT: a program, not a header

double now() {
  const auto time = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(time).count();
}

struct Case {
  std::string name;
  Scene scene;
  double duration;                         // [s]
  std::function<Points(double)> solution;  // closed form, where there is one
};

State stateOf(const Scene& scene) {
  State state;
  const auto& particles = scene.particles().items();
  state.positions.resize(3, particles.size());
  state.angular_velocities.resize(3, particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i) {
    state.positions.col(i) = particles[i].position;
    state.angular_velocities.col(i) = particles[i].angular_velocity;
  }
  return state;
}

Scene sceneOf(const std::vector<Particle>& particles, const SpringLists& springs) {
  Scene scene;
  scene.addParticles(particles);
  scene.addSprings(springs, stateOf(scene).positions);
  return scene;
}

AngleSpring angleSpring(std::uint32_t a, std::uint32_t b, double rest, double stiffness) {
  AngleSpring spring;
  spring.particles = {a, b};
  spring.rest_angle = rest;
  spring.stiffness = stiffness;
  return spring;
}

// --- the scenes ---

Case pair() {
  std::vector<Particle> particles(2);
  SpringLists springs;
  springs.get<AngleSpring>() = {angleSpring(0, 1, 1, 1)};
  const auto at = [](double time) {
    const double half = (1 + 0.3 * std::cos(std::sqrt(2.) * time)) / 2;
    Points positions(3, 2);
    positions.col(0) = Vector3(std::cos(half), -std::sin(half), 0);
    positions.col(1) = Vector3(std::cos(half), std::sin(half), 0);
    return positions;
  };
  for (int i = 0; i < 2; ++i) particles[i].position = at(0).col(i);
  return {"pair", sceneOf(particles, springs), 20, at};
}

std::vector<Particle> spread(double damping) {
  std::vector<Particle> particles(3);
  particles[0].position = Vector3(1, 0.15, 0.05);
  particles[1].position = Vector3(0.9, 0.5, 0.1);
  particles[2].position = Vector3(0.9, 0.1, 0.5);
  for (Particle& particle : particles) particle.damping = damping;
  return particles;
}

SpringLists triangleOfArcs(double damping, double stiffest) {
  SpringLists springs;
  springs.get<AngleSpring>() = {angleSpring(0, 1, spherical_springs::core::kPi / 2, stiffest),
                                angleSpring(1, 2, spherical_springs::core::kPi / 2, 1),
                                angleSpring(2, 0, spherical_springs::core::kPi / 2, 1)};
  for (AngleSpring& spring : springs.get<AngleSpring>()) spring.damping = damping;
  return springs;
}

Scene mesh(double damping) {
  const benchmark_scenes::Mesh sphere = benchmark_scenes::icosphere(3);
  std::mt19937 generator(1);
  const auto noise = [&] { return generator() / 2147483648. - 1; };
  std::vector<Particle> particles(sphere.vertices.size());
  for (std::size_t i = 0; i < particles.size(); ++i) {
    particles[i].position = sphere.vertices[i] + 0.01 * Vector3(noise(), noise(), noise());
  }
  SpringLists springs;
  for (const auto& [a, b] : sphere.edges) {
    const double angle = arc(sphere.vertices[a], sphere.vertices[b]).angle;
    springs.get<AngleSpring>().push_back(angleSpring(a, b, angle * (1 + 0.1 * noise()), 1));
    springs.get<AngleSpring>().back().damping = damping;
  }
  for (const auto& face : sphere.faces) {
    const auto& v = sphere.vertices;
    SolidAngleSpring spring;
    spring.particles = face;
    spring.rest_solid_angle = solidAngle(v[face[0]], v[face[1]], v[face[2]]) * (1 + 0.2 * noise());
    spring.stiffness = 10;
    springs.get<SolidAngleSpring>().push_back(spring);
  }
  return sceneOf(particles, springs);
}

std::vector<Case> cases() {
  return {pair(),
          {"figure 3", sceneOf(spread(0.5), triangleOfArcs(0, 1)), 10, nullptr},
          {"mesh", mesh(0), 5, nullptr},
          {"damped mesh", mesh(0.2), 5, nullptr},
          {"stiff", sceneOf(spread(0), triangleOfArcs(0, 1e6)), 0.2, nullptr},
          // Until its way depends on all that came before.
          {"tumbling", testing::tumblingScene(3), 4, nullptr}};
}

// --- stepping ---

struct Outcome {
  Points positions;
  double energy_error;  // relative to the energy at the start; 0 where it is not kept
  double wall_time;     // [s]
};

Outcome stepped(const Case& c, IntegrationMethod method, double time_step, int steps) {
  const auto plan = std::make_shared<const Plan>(c.scene, System::Options());
  State state = stateOf(c.scene);
  const double before = energies(*plan, state).total();
  const auto integrator = makeIntegrator(plan, method, time_step);
  const double begin = now();
  for (int i = 0; i < steps; ++i) integrator->step(state);
  const double wall_time = now() - begin;
  const double after = energies(*plan, state).total() + state.dissipated;
  return {state.positions, std::abs(after - before) / before, wall_time};
}

/// The report has no damping of whole springs; its scenes here have none.
bool isTranscribable(const Case& c) {
  const auto& arcs = c.scene.springs<AngleSpring>().items();
  return std::none_of(arcs.begin(), arcs.end(),
                      [](const AngleSpring& spring) { return spring.damping > 0; });
}

Outcome transcribed(const Case& c, double time_step, int steps) {
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
            [](const Outcome& a, const Outcome& b) { return a.wall_time < b.wall_time; });
  return outcomes[1];
}

double distance(const Points& a, const Points& b) { return (a - b).colwise().norm().maxCoeff(); }

void measureSteps(const Case& c, double budget, std::ostream& csv) {
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
      csv << c.name << "," << name << "," << c.duration / steps << ","
          << outcome.wall_time / c.duration << "," << distance(outcome.positions, reference) << ","
          << outcome.energy_error << "\n";
      if (outcome.wall_time > budget) break;
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
  const Scene scene = mesh(0);
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
  steps << "scene,method,time_step,wall_per_second,trajectory_error,energy_error\n";
  for (const Case& c : cases()) {
    std::cout << c.name << std::endl;
    measureSteps(c, budget, steps);
  }
  std::ofstream relaxation(argv[2]);
  relaxation << "method,wall_time,max_torque\n";
  std::cout << "relaxation" << std::endl;
  measureRelaxation(relaxation);
  return steps && relaxation ? 0 : 1;
}
