// Maps a closed surface to the sphere by way of the node; options.cpp says how to ask for it.
#include <ros/init.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <stdexcept>

#include "../available_threads.h"
#include "../files.h"
#include "face_files.h"
#include "interruption.h"
#include "obj_file.h"
#include "progress_line.h"
#include "spherical_springs/mesh/distortion.h"
#include "spherical_springs/mesh/sphere_map.h"
#include "spherical_springs/range.h"
#include "springs_node.h"
#include "task.h"
#include "texture_coordinates.h"

namespace spherical_springs::relax_mesh {
namespace {

namespace fs = std::filesystem;
using mesh::FaceDistortion;

/// Of angle springs beside solid-angle springs: these alone leave some freedom.
constexpr double kWeakest = 1e-5;

/// Of the map and of its relaxation [s]: 17 in all up to 10,000 vertices, 80 for 50,000.
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

Points mapOf(const Task& task, const Options& asked) {
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

void write(const Options& options, const Task& task, const Points& map,
           const FaceDistortion& faces) {
  core::replaceFile(options.output, [&](std::ostream& out) {
    mesh::writeObj(out, {map, task.surface.faces});
  });
  if (!options.uv.empty()) {
    core::replaceFile(options.uv, [&](std::ostream& out) {
      writeObj(out, task.surface, mesh::longitudeLatitude(map, task.surface.faces));
    });
  }
  if (!options.metrics.empty()) {
    core::replaceFile(options.metrics,
                      [&](std::ostream& out) { writeMetrics(out, task.shares, faces); });
  }
}

void run(const Options& options) {
  const Task task = readTask(options);
  const auto distortionOf = [&](const Points& map) {
    return faceDistortion(task.surface, task.shares, map);
  };
  if (task.inside_out) {
    std::cerr << "warning: the faces of " << core::onOneLine(options.mesh)
              << " look inwards: seen from outside they turn clockwise, and the map shows them "
                 "mirrored; with two corners of each face swapped it does not"
              << std::endl;
  }
  SpringsNode node(options.node);
  const auto begin = ros::WallTime::now();
  if (task.start) {
    const FaceDistortion start = distortionOf(*task.start);
    print("before", start, 0);
    if (!coversOnce(summary(start))) {
      std::cout << "the start does not cover the sphere once without folds: passed over"
                << std::endl;
    }
  }
  Points map = mapOf(task, options);
  FaceDistortion faces = distortionOf(map);
  if (!task.start) print("before", faces, secondsSince(begin));

  const Points relaxed =
      node.relax({map, task.surface.faces, task.shares, kWeakest + options.angle_weight},
                 Times(task.surface.vertices.cols()).relaxation);
  const FaceDistortion after = distortionOf(relaxed);
  if (isBetter(summary(after), summary(faces)) && edgesBelowPi(task.surface.faces, relaxed)) {
    map = relaxed;
    faces = after;
  }
  if (!coversOnce(summary(faces))) refuseWithoutMap(options.mesh);
  write(options, task, map, faces);
  print("after", faces, secondsSince(begin));
}

}  // namespace
}  // namespace spherical_springs::relax_mesh

int main(int argc, char** argv) {
  using namespace spherical_springs::relax_mesh;
  try {
    ros::init(argc, argv, "relax_mesh",  // takes its arguments
              ros::init_options::AnonymousName | ros::init_options::NoSigintHandler);
    keepInterruptions();
    const auto options = parseOptions({argv + 1, argv + argc});
    if (options) run(*options);
  } catch (const std::exception& fault) {
    // ROS shows names that it does not take as they are.
    std::cerr << "error: " << spherical_springs::core::onOneLine(fault.what()) << std::endl;
    return 1;
  }
  return 0;
}
