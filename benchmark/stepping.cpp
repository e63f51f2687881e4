// Time of a step for scenes of many sizes and kinds, beside the report transcribed, in Markdown.
// Arguments: levels of the icosphere, or --smoke, or --write-scene FILE LEVEL.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <numeric>
#include <string>
#include <thread>
#include <vector>

#include "memory_use.h"
#include "scene_parts.h"
#include "spherical_springs/integrator.h"
#include "spherical_springs/scene_file.h"
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
      makeIntegrator(std::make_shared<const Plan>(scene, options), method, kTimeStep);
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

/// Bytes resident for a simulation that has stepped, beyond those before.
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

Parts mesh(int level, Springs springs = Springs::both) {
  benchmark_scenes::Random random(1);
  return benchmark_scenes::displacedMesh(level, springs, random);
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

struct Case {
  std::string name;
  std::function<Parts()> parts;
  IntegrationMethod method = IntegrationMethod::euler;
  double bytes = 0;  ///< that a simulation of it holds once it steps
};

std::vector<Case> sizes(const std::vector<int>& levels) {
  std::vector<Case> cases;
  for (const int level : levels) cases.push_back({"", [=] { return mesh(level); }});
  return cases;
}

std::vector<Case> kinds(int level) {
  const auto both = [=] { return mesh(level); };
  return {{"angle springs", [=] { return mesh(level, Springs::arcs); }},
          {"solid-angle springs", [=] { return mesh(level, Springs::triangles); }},
          {"both", both},
          {"both, sent in random order",
           [=] {
             benchmark_scenes::Random random(2);
             return shuffled(both(), random);
           }},
          {"both, damped particles", [=] { return withDampedParticles(both()); }},
          {"both, damped angle springs", [=] { return withDampedSprings(both()); }},
          {"all three", [=] { return withOrientedArcs(both()); }},
          {"both, `verlet`", both, IntegrationMethod::verlet},
          {"both, `fourth_order`, six stages", both, IntegrationMethod::fourth_order}};
}

/// To be called while this process has neither threads nor memory to use again.
void measureBytes(std::vector<Case>& cases) {
  for (Case& c : cases) c.bytes = bytesHeld(c.parts);
}

bool isTranscribable(const Scene& scene) {
  return scene.springs<OrientedAngleSpring>().size() == 0;
}

void print(const Case& c, const Effort& effort) {
  const Scene scene = c.parts().scene();
  Contender one = ours(scene, c.method, 1);
  Contender all = ours(scene, c.method, cores());
  Contender report = transcribed(scene);
  race({&one, &all, &report}, effort.rounds, effort.seconds_a_turn);
  const double springs = static_cast<double>(scene.springCount());
  const double ns = 1e9 / springs;
  if (!c.name.empty()) std::printf("| %s ", c.name.c_str());
  std::printf("| %zu | %.0f | %.2f | %.2f ", scene.particles().size(), springs, ns * one.median(),
              ns * all.median());
  if (isTranscribable(scene)) {
    std::printf("| %.1f | %.1f | %.1f ", ns * report.median(), report.median() / one.median(),
                report.median() / all.median());
  } else {
    std::printf("| - | - | - ");
  }
  std::printf("| %.0f | %.0f |\n", 1 / all.median(), c.bytes / springs);
  std::fflush(stdout);
}

void printHead(const char* first) {
  std::printf(
      "%s| particles | springs | ns a spring, one thread | %d threads | transcription | ratio, one "
      "thread | %d threads | steps/s | bytes a spring |\n",
      first, cores(), cores());
  std::printf("%s| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
              *first == 0 ? "" : "| --- ");
}

void printSizes(const std::vector<Case>& cases, const Effort& effort) {
  printHead("");
  for (const Case& c : cases) print(c, effort);
  std::printf("\n");
}

void printKinds(const std::vector<Case>& cases, const Effort& effort) {
  printHead("| scene ");
  for (const Case& c : cases) print(c, effort);
  std::printf("\n");
}

/// Whether a step of the same scene on a geodesic grid takes less than it simulates, on all cores.
bool holdsRealTime(std::uint32_t frequency, const Effort& effort) {
  benchmark_scenes::Random random(1);
  const auto grid = benchmark_scenes::geodesicGrid(frequency);
  const Scene scene = benchmark_scenes::displaced(grid, Springs::both, random).scene();
  Contender all = ours(scene, IntegrationMethod::euler, cores());
  race({&all}, effort.rounds, effort.seconds_a_turn);
  return all.median() < kTimeStep;
}

void printLargestInRealTime(const Effort& effort) {
  std::uint32_t holds = 1, fails = 2;
  for (; holdsRealTime(fails, effort); fails *= 2) holds = fails;
  while (fails - holds > 1) {
    const std::uint32_t middle = (holds + fails) / 2;
    (holdsRealTime(middle, effort) ? holds : fails) = middle;
  }
  std::printf("The largest geodesic grid that holds real time at a step of 1 ms: %u particles.\n\n",
              10 * holds * holds + 2);
}

void printThree() {
  Parts parts = benchmark_scenes::particlesAt({{1, 0.1, 0.1}, {0.1, 1, 0.1}, {0.1, 0.1, 1}});
  for (std::uint32_t i = 0; i < 3; ++i) parts.addArc(i, (i + 1) % 3, kPi / 2);
  const Scene scene = parts.scene();
  Contender all = ours(scene, IntegrationMethod::euler, cores());
  race({&all}, 9, 0.01);
  std::printf("Three particles with three arcs: %.2f us a step.\n", 1e6 * all.median());
}

/// Writes the mesh of a level, for a node to load.
int writeMesh(const char* path, int level) {
  writeScene(path, mesh(level).scene(), 0);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 4 && std::string(argv[1]) == "--write-scene") {
    return writeMesh(argv[2], std::atoi(argv[3]));
  }
  const bool smoke = argc == 2 && std::string(argv[1]) == "--smoke";
  const Effort effort = smoke ? Effort{1, 1e-3} : Effort{9, 0.1};
  std::vector<int> levels = smoke ? std::vector<int>{0, 1, 3} : std::vector<int>{};
  if (!smoke) {
    for (int i = 1; i < argc; ++i) levels.push_back(std::atoi(argv[i]));
    if (levels.empty()) levels = {0, 1, 2, 3, 4, 5, 6, 7, 8};
  }
  std::vector<Case> by_size = sizes(levels), by_kind = kinds(smoke ? 3 : 5);
  measureBytes(by_size);
  measureBytes(by_kind);
  printSizes(by_size, effort);
  printLargestInRealTime(effort);
  printKinds(by_kind, effort);
  printThree();
  return 0;
}
