// Relaxation beside Ceres Solver: seconds and memory on the benchmark scene, and where both end in
// networks of every sort. Prints tables in Markdown.
#include "spherical_springs/relaxation.h"

#include <algorithm>
#include <boost/program_options.hpp>
#include <chrono>
#include <cmath>
#include <functional>
#include <iostream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "ceres_relaxation.h"
#include "curvature.h"
#include "memory_use.h"
#include "networks.h"
#include "relaxation/torque_limit.h"
#include "scene_parts.h"
#include "spherical_springs/scene_file.h"

namespace {

using namespace spherical_springs::core;  // NOLINT: a program, not a header
using namespace benchmark_scenes;         // NOLINT

struct Settings {
  std::vector<int> levels;
  bool networks = false;
  std::string only;
  bool without_ceres = false;
  double tolerance = 0;
  double max_time = 0;
  std::string scene_file;
};

/// A few significant digits, or "-" for no number.
std::string text(std::optional<double> number, int digits = 3) {
  if (!number) return "-";
  std::ostringstream out;
  out.precision(digits);
  out << *number;
  return out.str();
}

void printRow(const std::vector<std::string>& cells) {
  for (const std::string& cell : cells) std::cout << "| " << cell << " ";
  std::cout << "|" << std::endl;
}

void printHeader(const std::vector<std::string>& cells) {
  printRow(cells);
  printRow(std::vector<std::string>(cells.size(), "---"));
}

struct Timed {
  RelaxationResult result;
  double seconds;
};

Timed timedRelax(const System& system, const Points& start, const Settings& settings) {
  RelaxationOptions options;
  options.tolerance = settings.tolerance;
  options.max_time = settings.max_time;
  const auto begin = std::chrono::steady_clock::now();
  RelaxationResult result = relax(system, start, options);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
  return {std::move(result), elapsed.count()};
}

/// Several runs where they are short; the one of median time.
template <class Run>
auto medianOf(const Run& run) {
  std::vector<decltype(run())> runs = {run()};
  const double first = runs[0].seconds;
  const int count = first < 1 ? 7 : first < 10 ? 3 : 1;
  while (static_cast<int>(runs.size()) < count) runs.push_back(run());
  std::sort(runs.begin(), runs.end(),
            [](const auto& a, const auto& b) { return a.seconds < b.seconds; });
  return runs[runs.size() / 2];
}

System systemOf(const Scene& scene, int threads) {
  System::Options options;
  options.threads = threads;
  return System(scene, options);
}

/// Difference of two energies, relative to the greater; 1e-12 of `start` counts as rounding.
double relativeDifference(double energy, double other, double start) {
  return (energy - other) / std::max({energy, other, 1e-12 * start});
}

// --- the benchmark scene ---

struct Measured {
  double particles;
  double one_thread, two_threads;  // [s]
  std::optional<double> ceres;     // [s]
};

MemoryUse memoryOf(int level, const Settings& settings) {
  return memoryUse([&] {
    const Scene scene = benchmarkScene(level);
    return [system = systemOf(scene, 1), start = startOf(scene), &settings] {
      timedRelax(system, start, settings);
    };
  });
}

Measured measureScene(int level, const MemoryUse& memory, const Settings& settings) {
  const Scene scene = benchmarkScene(level);
  const Points start = startOf(scene);
  const System system = systemOf(scene, 1);
  const Timed one = medianOf([&] { return timedRelax(system, start, settings); });
  const System two_threads = systemOf(scene, 2);
  const Timed two = medianOf([&] { return timedRelax(two_threads, start, settings); });

  std::optional<CeresResult> ceres;
  std::optional<double> ratio, difference;
  if (!settings.without_ceres) {
    ceres = medianOf(
        [&] { return relaxByCeres(system, start, settings.tolerance, settings.max_time); });
    ratio = ceres->seconds / two.seconds;
    difference =
        relativeDifference(two.result.energy_after, system.potential(ceres->positions).total(),
                           two.result.energy_before);
  }
  const double particles = static_cast<double>(start.cols());
  printRow({text(particles, 7), text(one.seconds), text(two.seconds),
            std::to_string(two.result.iterations), ceres ? text(ceres->seconds) : "-",
            ceres ? std::to_string(ceres->iterations) : "-", text(ratio),
            text(two.result.energy_after, 8), text(difference, 2), text(two.result.max_torque, 2),
            one.result.positions == two.result.positions ? "yes" : "no",
            text((memory.peak - memory.prepared) / particles / 1000),
            text(memory.peak / particles / 1000), two.result.message});
  return {particles, one.seconds, two.seconds,
          ceres ? std::optional<double>(ceres->seconds) : std::nullopt};
}

/// The exponent of the power law that fits best: least squares of the logarithms.
double growth(const std::vector<Measured>& rows,
              const std::function<double(const Measured&)>& seconds) {
  Eigen::VectorXd x(rows.size()), y(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    x[i] = std::log(rows[i].particles);
    y[i] = std::log(seconds(rows[i]));
  }
  x.array() -= x.mean();
  return x.dot(y) / x.squaredNorm();
}

void measureScenes(const Settings& settings) {
  std::vector<MemoryUse> memory;
  for (const int level : settings.levels) memory.push_back(memoryOf(level, settings));

  printHeader({"particles", "1 thread [s]", "2 threads [s]", "iterations", "Ceres [s]",
               "iterations", "Ceres / 2 threads", "energy [J]", "against Ceres's", "torque [N m]",
               "same bits", "memory to relax [kB a particle]", "with the system", "message"});
  std::vector<Measured> rows;
  for (std::size_t i = 0; i < memory.size(); ++i) {
    rows.push_back(measureScene(settings.levels[i], memory[i], settings));
  }
  if (rows.size() < 2) return;
  const auto grows = [&](auto seconds) { return text(growth(rows, seconds)); };
  std::cout << "\nGrowth with the number of particles, exponents: "
            << grows([](const Measured& row) { return row.one_thread; }) << " on one thread, "
            << grows([](const Measured& row) { return row.two_threads; }) << " on two";
  if (!settings.without_ceres) {
    std::cout << ", Ceres " << grows([](const Measured& row) { return *row.ceres; });
  }
  std::cout << ".\n";
}

// --- the networks ---

std::string eigenvalue(const EigenvalueRange& range) {
  if (!range.resolved) return "unresolved";
  return text(range.largest > 0 ? range.smallest / range.largest : 0, 2);
}

void measureNetwork(const Network& network, const Settings& settings) {
  const Scene scene = network.make();
  const System system = systemOf(scene, 2);
  const Points start = startOf(scene);
  const Timed ours = timedRelax(system, start, settings);
  const double energy_before = system.potential(start).total();
  std::vector<std::string> cells = {network.name, text(energy_before, 4),
                                    text(ours.result.energy_after, 7)};
  std::vector<std::string> of_ceres = {"-", "-", "-", "-", "-"};
  if (!settings.without_ceres) {
    const double tolerance =
        settings.tolerance > 0 ? settings.tolerance : 1e-9 * system.largestStiffness();
    const CeresResult ceres = relaxByCeres(system, start, tolerance, settings.max_time);
    const double energy = system.potential(ceres.positions).total();
    of_ceres = {text(energy, 7),
                text(relativeDifference(ours.result.energy_after, energy, energy_before), 2),
                text(largestTorque(system, ceres.positions), 2), std::to_string(ceres.iterations),
                text(ceres.seconds) + (ceres.converged ? "" : " (not converged)")};
  }
  const SparseMatrix hessian = differenceHessian(system, ours.result.positions);
  cells.insert(
      cells.end(),
      {of_ceres[0], of_ceres[1], text(largestTorque(system, ours.result.positions), 2), of_ceres[2],
       std::to_string(ours.result.iterations), of_ceres[3], text(ours.seconds), of_ceres[4],
       eigenvalue(eigenvalueRange(system, hessian, ours.result.positions)),
       text(leastDefiniteShift(hessian), 1), ours.result.message});
  printRow(cells);
}

void measureNetworks(const Settings& settings) {
  printHeader({"network", "energy at the start [J]", "energy [J]", "Ceres's", "against Ceres's",
               "torque [N m]", "Ceres's", "iterations", "Ceres's", "time [s]", "Ceres's",
               "smallest eigenvalue / largest", "definite from", "message"});
  for (const Network& network : networks()) {
    if (network.name.find(settings.only) != std::string::npos) measureNetwork(network, settings);
  }
}

// --- the command line ---

/// Nothing where only help was asked for.
std::optional<Settings> parsed(int argc, char** argv) {
  namespace po = boost::program_options;
  Settings settings;
  po::options_description all("Relaxation beside Ceres Solver");
  auto add = all.add_options();
  add("help", "show this");
  add("levels", po::value(&settings.levels)->multitoken(),
      "of the benchmark scene: 10 * 4^level + 2 particles each");
  add("networks", po::bool_switch(&settings.networks), "the networks of every sort");
  add("only", po::value(&settings.only), "only networks with this in their names");
  add("without-ceres", po::bool_switch(&settings.without_ceres), "leave Ceres Solver out");
  add("tolerance", po::value(&settings.tolerance),
      "largest torque left [N m]; default: 1e-9, for networks that of `relax`");
  add("max-time", po::value(&settings.max_time)->default_value(300), "of one relaxation [s]");
  add("write-scene", po::value(&settings.scene_file),
      "write the benchmark scene of the first level to this file, and measure nothing");
  po::variables_map values;
  po::store(po::parse_command_line(argc, argv, all), values);
  po::notify(values);
  if (values.count("help") || (settings.levels.empty() && !settings.networks)) {
    std::cout << all;
    return std::nullopt;
  }
  return settings;
}

void run(const Settings& settings) {
  if (!settings.scene_file.empty()) {
    writeScene(settings.scene_file, benchmarkScene(settings.levels.at(0)), 0);
    return;
  }
  if (!settings.levels.empty()) {
    Settings of_scene = settings;
    if (settings.tolerance == 0) of_scene.tolerance = 1e-9;
    measureScenes(of_scene);
  }
  if (settings.networks) measureNetworks(settings);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (const auto settings = parsed(argc, argv)) run(*settings);
  } catch (const std::exception& fault) {
    std::cerr << "error: " << fault.what() << "\n";
    return 1;
  }
  return 0;
}
