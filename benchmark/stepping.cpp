// Time of a step for scenes of many sizes and kinds, beside the report transcribed, in Markdown.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <memory>
#include <numeric>
#include <string>
#include <thread>
#include <vector>

#include "memory_use.h"
#include "scene_parts.h"
#include "spherical_springs/integrator.h"
#include "spherical_springs/simulation.h"
#include "transcription/native.h"

namespace {

using namespace spherical_springs::core;  // NOLINT: a program, not a header
using benchmark_scenes::Parts;
using benchmark_scenes::Springs;

constexpr double kTimeStep = 1e-3;  // [s]

/// Something that can be stepped, and how long a step of it took.
struct Contender {
  std::function<void(int)> step;
  int steps = 0;  ///< at a time
  std::vector<double> seconds = {};

  double median() {
    std::nth_element(seconds.begin(), seconds.begin() + seconds.size() / 2, seconds.end());
    return seconds[seconds.size() / 2];
  }
};

double timeOf(const Contender& contender, int steps) {
  const auto begin = std::chrono::steady_clock::now();
  contender.step(steps);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() / steps;
}

/// In turn, so that what else the machine does falls on all alike.
void race(const std::vector<Contender*>& contenders, int rounds, double seconds_a_turn) {
  for (Contender* contender : contenders) {
    const double first = timeOf(*contender, 1), second = timeOf(*contender, 1);
    contender->steps = std::max(1, static_cast<int>(seconds_a_turn / std::min(first, second)));
  }
  for (int round = 0; round < rounds; ++round) {
    for (Contender* contender : contenders) {
      contender->seconds.push_back(timeOf(*contender, contender->steps));
    }
  }
}

Contender ours(const Scene& scene, IntegrationMethod method, int threads) {
  System::Options options;
  options.threads = threads;
  State state;
  state.positions = benchmark_scenes::startOf(scene);
  state.angular_velocities = Points::Zero(3, state.positions.cols());
  const std::shared_ptr<Integrator> integrator =
      makeIntegrator(std::make_shared<const System>(scene, options), method, kTimeStep);
  integrator->take(state);
  return {[integrator](int steps) { integrator->advance(steps); }};
}

Contender transcribed(const Scene& scene) {
  const auto plain = std::make_shared<report::Scene>();
  for (const Particle& p : scene.particles().items()) {
    const Vector3& at = p.position;
    plain->particles.push_back({{at.x(), at.y(), at.z()}, {}, p.mass, p.damping});
  }
  for (const AngleSpring& s : scene.springs<AngleSpring>().items()) {
    plain->angle_springs.push_back(
        {{int(s.particles[0]), int(s.particles[1])}, s.rest_angle, s.stiffness});
  }
  for (const SolidAngleSpring& s : scene.springs<SolidAngleSpring>().items()) {
    const auto [i, j, k] = s.particles;
    plain->solid_angle_springs.push_back(
        {{int(i), int(j), int(k)}, s.rest_solid_angle, s.stiffness});
  }
  return {[plain](int steps) {
    for (int i = 0; i < steps; ++i) report::stepNatively(*plain, kTimeStep);
  }};
}

int cores() { return static_cast<int>(std::max(1u, std::thread::hardware_concurrency())); }

/// The parts of a scene in another order, all springs anywhere in their lists.
Parts shuffled(const Parts& parts, benchmark_scenes::Random& random) {
  const auto shuffle = [&](auto& list) {
    for (std::size_t i = list.size(); i > 1; --i) {
      std::swap(list[i - 1], list[random.below(static_cast<std::uint32_t>(i))]);
    }
  };
  std::vector<std::uint32_t> places(parts.size());
  std::iota(places.begin(), places.end(), 0);
  shuffle(places);
  Parts result = parts;
  for (std::size_t i = 0; i < places.size(); ++i) result.particles[places[i]] = parts.particles[i];
  forEachKind([&](auto kind) {
    auto& list = result.springs.get<typename decltype(kind)::type>();
    for (auto& spring : list) {
      for (std::uint32_t& particle : spring.particles) particle = places[particle];
    }
    shuffle(list);
  });
  return result;
}

/// Bytes that a simulation of the scene holds once it steps.
double bytesHeld(const std::function<Parts()>& parts) {
  const auto use = benchmark_scenes::memoryUse([&] {
    const auto simulation = std::make_shared<Simulation>(Simulation::Settings());
    {
      Parts made = parts();
      simulation->addParticles(std::move(made.particles));
      simulation->addSprings(std::move(made.springs));
    }
    simulation->step(1);
    return [simulation] {};
  });
  return static_cast<double>(use.prepared);
}

struct Effort {
  int rounds;
  double seconds_a_turn;
};

// --- sizes ---

Parts mesh(int level, Springs springs = Springs::both) {
  benchmark_scenes::Random random(1);
  return benchmark_scenes::displacedMesh(level, springs, random);
}

/// @return seconds a step, on all cores.
double printSize(int level, const Effort& effort) {
  // Before there are threads, which the measuring process would not have.
  const double bytes = bytesHeld([&] { return mesh(level); });
  const Scene scene = mesh(level).scene();
  Contender one = ours(scene, IntegrationMethod::euler, 1);
  Contender all = ours(scene, IntegrationMethod::euler, cores());
  Contender report = transcribed(scene);
  race({&one, &all, &report}, effort.rounds, effort.seconds_a_turn);
  const double springs = static_cast<double>(scene.springCount());
  const double ns = 1e9 / springs;
  std::printf("| %zu | %.0f | %.2f | %.2f | %.1f | %.1f | %.1f | %.0f | %.0f |\n",
              scene.particles().size(), springs, ns * one.median(), ns * all.median(),
              ns * report.median(), report.median() / one.median(), report.median() / all.median(),
              1 / all.median(), bytes / springs);
  std::fflush(stdout);
  return all.median();
}

void printSizes(const std::vector<int>& levels, const Effort& effort) {
  std::printf(
      "| particles | springs | ns a spring, one thread | all %d | transcription | ratio, one "
      "thread "
      "| all | steps/s, all | bytes a spring |\n| --- | --- | --- | --- | --- | --- | --- | --- | "
      "--- |\n",
      cores());
  std::size_t largest = 0;
  for (const int level : levels) {
    if (printSize(level, effort) < kTimeStep) largest = 10 * (std::size_t(1) << 2 * level) + 2;
  }
  std::printf("\nThe largest of these that hold real time at a step of 1 ms: %zu particles.\n\n",
              largest);
}

// --- kinds ---

void printKind(const char* name, const std::function<Parts()>& parts, const Effort& effort,
               IntegrationMethod method = IntegrationMethod::euler) {
  const double bytes = bytesHeld(parts);
  const Scene scene = parts().scene();
  Contender one = ours(scene, method, 1);
  race({&one}, effort.rounds, effort.seconds_a_turn);
  const double springs = static_cast<double>(scene.springCount());
  std::printf("| %s | %.0f | %.2f | %.0f |\n", name, springs, 1e9 / springs * one.median(),
              bytes / springs);
  std::fflush(stdout);
}

Parts withOrientedArcs(Parts parts) {
  for (const SolidAngleSpring& triangle : parts.triangles()) {
    OrientedAngleSpring spring;
    spring.particles = triangle.particles;
    spring.rest_angle = 0.01;
    spring.stiffness = 1;
    spring.width = 1e-5;
    parts.orientedArcs().push_back(spring);
  }
  return parts;
}

Parts withDampedParticles(Parts parts) {
  for (Particle& particle : parts.particles) particle.damping = 0.1;
  return parts;
}

Parts withDampedSprings(Parts parts) {
  for (AngleSpring& spring : parts.arcs()) spring.damping = 0.1;
  return parts;
}

void printKinds(int level, const Effort& effort) {
  std::printf(
      "| scene | springs | ns a spring, one thread | bytes a spring |\n| --- | --- | --- | --- "
      "|\n");
  const auto both = [=] { return mesh(level); };
  printKind(
      "angle springs", [=] { return mesh(level, Springs::arcs); }, effort);
  printKind(
      "solid-angle springs", [=] { return mesh(level, Springs::triangles); }, effort);
  printKind("both", both, effort);
  printKind(
      "both, sent in random order",
      [=] {
        benchmark_scenes::Random random(2);
        return shuffled(mesh(level), random);
      },
      effort);
  printKind(
      "both, damped particles", [=] { return withDampedParticles(both()); }, effort);
  printKind(
      "both, damped angle springs", [=] { return withDampedSprings(both()); }, effort);
  printKind(
      "all three", [=] { return withOrientedArcs(both()); }, effort);
  printKind("both, `verlet`", both, effort, IntegrationMethod::verlet);
  printKind("both, `fourth_order`, six stages", both, effort, IntegrationMethod::fourth_order);
  std::printf("\n");
}

void printThree() {
  Parts parts = benchmark_scenes::particlesAt({{1, 0.1, 0.1}, {0.1, 1, 0.1}, {0.1, 0.1, 1}});
  for (std::uint32_t i = 0; i < 3; ++i) parts.addArc(i, (i + 1) % 3, kPi / 2);
  const Scene scene = parts.scene();
  Contender all = ours(scene, IntegrationMethod::euler, cores());
  race({&all}, 9, 0.01);
  std::printf("Three particles with three arcs: %.2f us a step.\n", 1e6 * all.median());
}

}  // namespace

int main(int argc, char** argv) {
  const bool smoke = argc == 2 && std::string(argv[1]) == "--smoke";
  const Effort effort = smoke ? Effort{1, 1e-3} : Effort{9, 0.1};
  std::vector<int> levels = smoke ? std::vector<int>{0, 1, 3} : std::vector<int>{};
  if (!smoke) {
    for (int i = 1; i < argc; ++i) levels.push_back(std::atoi(argv[i]));
    if (levels.empty()) levels = {0, 1, 2, 3, 4, 5, 6, 7, 8};
  }
  printSizes(levels, effort);
  printKinds(smoke ? 3 : 5, effort);
  printThree();
  return 0;
}
