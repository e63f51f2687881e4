// Maps a closed surface to the sphere by way of the node; options.cpp says how to ask for it.
#include <ros/init.h>

#include <algorithm>
#include <boost/thread/exceptions.hpp>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>

#include "base/available_threads.h"
#include "base/files.h"
#include "relax_mesh/interruption.h"
#include "relax_mesh/output_files.h"
#include "relax_mesh/progress_line.h"
#include "relax_mesh/springs_node.h"
#include "relax_mesh/task.h"
#include "spherical_springs/maps/distortion.h"
#include "spherical_springs/maps/sphere_map.h"
#include "spherical_springs/range.h"

namespace spherical_springs::relax_mesh {
namespace {

namespace fs = std::filesystem;
using mesh::FaceDistortion;

/// Relative stiffness of angle springs beside solid-angle springs, which alone leave some freedom.
constexpr double kWeakest = 1e-5;

constexpr const char* kNoMemory = "there is not enough memory";
constexpr const char* kMapSoFar = " to improve the map further; the best so far has been written";

/// Time limits of the map and of its relaxation [s]: 17 in all up to 10,000 vertices, 80 for
/// 50,000.
struct Times {
  explicit Times(Eigen::Index vertices)
      : map(std::max(16., 1.5e-3 * vertices)), relaxation(std::max(1., 0.1e-3 * vertices)) {}
  double map, relaxation;
};

double secondsSince(const ros::WallTime& begin) { return (ros::WallTime::now() - begin).toSec(); }

void print(const char* when, const FaceDistortion& faces, double seconds) {
  constexpr double kDegrees = 180 / core::kPi;
  const mesh::Distortion d = summary(faces);
  std::printf(
      "%s: areas: spread %.3g, mean %.3g, worst face %.3g, folded %ld, sum %.9g sr; "
      "angles: mean %.3g deg, worst %.3g deg; %.2f s\n",
      when, d.spread, d.mean, d.worst, static_cast<long>(d.folded), d.total_area,
      d.mean_angle * kDegrees, d.worst_angle * kDegrees, seconds);
  std::fflush(stdout);
}

[[noreturn]] void refuseWithoutMap(const fs::path& surface) {
  throw std::runtime_error(
      core::onOneLine(surface) +
      ": no map without folds was found, and no file has been written; to help it, begin from one "
      "(--sphere), or give a mesh with fewer thin triangles and areas that differ less");
}

/// `out_of_memory`: whether that is why the map is no better.
Points mapOf(const Task& task, const Options& asked, bool& out_of_memory) {
  mesh::MapOptions options;
  options.angle_weight = asked.angle_weight;
  options.max_time = Times(task.surface.vertices.cols()).map;
  options.threads = core::availableThreads();
  ProgressLine progress("mapping");
  options.go_on = [&](double fraction) {
    progress.show(fraction);
    throwIfInterrupted();
    return ros::ok();
  };
  options.out_of_memory = [&] { out_of_memory = true; };
  try {
    return about(task.shares_from, [&] {
      return task.start ? sphereMap(task.surface, task.shares, *task.start, options)
                        : sphereMap(task.surface, task.shares, options);
    });
  } catch (const mesh::NoMap&) {
    refuseWithoutMap(asked.mesh);
  }
}

bool coversOnce(const mesh::Distortion& d) {
  return d.folded == 0 && std::abs(d.total_area - 4 * core::kPi) < 1e-6;
}

/// Whether every edge is shorter than pi by 1e-6 rad: nearer to it plain formulas of areas lose
/// digits.
bool edgesBelowPi(const mesh::Faces& faces, const Points& map) {
  for (Eigen::Index f = 0; f < faces.cols(); ++f) {
    for (int k = 0; k < 3; ++k) {
      if ((map.col(faces(k, f)) + map.col(faces((k + 1) % 3, f))).norm() < 1e-6) return false;
    }
  }
  return true;
}

/// Whether the map that springs have relaxed goes before the one they began from.
bool isBetter(const mesh::Distortion& relaxed, const mesh::Distortion& before) {
  return coversOnce(relaxed) && relaxed.spread < before.spread;
}

void warn(const std::string& text) {
  std::cerr << "warning: " << core::onOneLine(text) << std::endl;
}

void printWordsOf(const SpringsNode& node) {
  for (const std::string& line : node.said()) {
    std::cout << node.name() << ": " << core::onOneLine(line) << std::endl;
  }
}

/// Lets the node relax a map that has been written. Returns nothing where that fails, after a
/// warning that says why.
std::optional<Points> relaxed(SpringsNode& node, const Network& network, double max_time) {
  const std::string consequence = "; the map has been written, but springs have not relaxed it";
  try {
    return node.relax(network, max_time);
  } catch (const Interrupted& fault) {
    printWordsOf(node);
    throw std::runtime_error(fault.what() + consequence);
  } catch (const std::bad_alloc&) {
    warn(kNoMemory + consequence);
  } catch (const std::exception& fault) {
    warn(fault.what() + consequence);
  }
  return {};
}

void tellOfTask(const Task& task, const Options& options) {
  for (const std::string& sentence : task.repairs) {
    std::cout << "repair: " << sentence << std::endl;
  }
  if (!task.inside_out) return;
  warn(
      "the faces of " + options.mesh.string() +
      " look inwards: seen from outside they turn clockwise, and the map shows them mirrored; with "
      "two corners of each face swapped it does not");
}

void printStart(const FaceDistortion& start) {
  print("before", start, 0);
  if (coversOnce(summary(start))) return;
  std::cout << "the start does not cover the sphere once without folds: passed over" << std::endl;
}

void printTexture(const Options& options, const Task& task, const Points& map) {
  if (options.uv.empty()) return;
  Options other = options;
  other.projection = mesh::Projection::longitude_latitude;
  std::printf("texture: spread of texel density %.3g; %.3g in longitude and latitude\n",
              spreadOfTexelDensity(textureOf(options, task, map)),
              spreadOfTexelDensity(textureOf(other, task, map)));
  std::fflush(stdout);
}

/// Writes a map in the place of the one before.
void rewriteFiles(const Options& options, const Task& task, const Points& map,
                  const FaceDistortion& faces) {
  try {
    writeFiles(options, task, map, faces);
  } catch (const std::exception& fault) {
    throw std::runtime_error(fault.what() + std::string("; all others hold the map before springs "
                                                        "have relaxed it"));
  }
}

/// Asks what may fail beside the map before that is computed, and writes the map before what may
/// fail after that.
void run(const Options& options) {
  const Task task = readTask(options);
  const mesh::Faces& triangles = task.surface.faces;
  const Times times(task.surface.vertices.cols());
  const auto distortionOf = [&](const Points& map) {
    return faceDistortion(task.surface, task.shares, map);
  };
  tellOfTask(task, options);
  SpringsNode node(options.node);
  node.requireRoomFor(task.surface.vertices.cols(), springCount(triangles.cols()));
  if (node.wasBusy()) {
    warn(node.name() + " relaxes for another client; it will be asked again when there is a map");
  }
  const auto begin = ros::WallTime::now();
  if (task.start) printStart(distortionOf(*task.start));
  bool out_of_memory = false;
  const Points map = mapOf(task, options, out_of_memory);
  FaceDistortion faces = distortionOf(map);
  Points best = map;
  if (!coversOnce(summary(faces))) refuseWithoutMap(options.mesh);
  writeFiles(options, task, map, faces);
  if (out_of_memory) warn(std::string(kNoMemory) + kMapSoFar);
  if (!task.start) print("before", faces, secondsSince(begin));

  const Network network{map, triangles, task.shares, kWeakest + options.angle_weight};
  const auto better = relaxed(node, network, times.relaxation);
  if (better && edgesBelowPi(triangles, *better)) {
    const FaceDistortion after = distortionOf(*better);
    if (isBetter(summary(after), summary(faces))) {
      rewriteFiles(options, task, *better, after);
      faces = after;
      best = *better;
    }
  }
  print("after", faces, secondsSince(begin));
  printTexture(options, task, best);
  printWordsOf(node);
}

}  // namespace
}  // namespace spherical_springs::relax_mesh

int main(int argc, char** argv) {
  using namespace spherical_springs::relax_mesh;
  try {
    ros::init(argc, argv, "relax_mesh",  // takes its arguments
              ros::init_options::AnonymousName | ros::init_options::NoSigintHandler);
    keepInterruptions();
    std::signal(SIGXFSZ, SIG_IGN);  // a file that grows too long is one that cannot be written
    const auto options = parseOptions({argv + 1, argv + argc});
    if (options) run(*options);
  } catch (const Interrupted& fault) {
    std::cerr << "error: " << fault.what() << "; no file has been written" << std::endl;
    return 1;
  } catch (const std::bad_alloc&) {
    std::cerr << "error: " << kNoMemory << std::endl;
    return 1;
  } catch (const boost::thread_resource_error&) {
    std::cerr << "error: " << kNoMemory << " for the threads of ROS, or there are too many"
              << std::endl;
    return 1;
  } catch (const std::exception& fault) {
    // ROS shows names that it does not take as they are.
    std::cerr << "error: " << spherical_springs::core::onOneLine(fault.what()) << std::endl;
    return 1;
  }
  return 0;
}
