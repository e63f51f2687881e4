// Maps a closed surface to the sphere; options.cpp says how to ask for it.
#include <ros/init.h>

#include <boost/thread/exceptions.hpp>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <new>
#include <stdexcept>
#include <string>

#include "base/files.h"
#include "relax_mesh/interruption.h"
#include "relax_mesh/map_by_node.h"
#include "relax_mesh/map_here.h"
#include "relax_mesh/output_files.h"
#include "relax_mesh/task.h"
#include "spherical_springs/maps/mesh_map.h"
#include "spherical_springs/range.h"

namespace spherical_springs::relax_mesh {
namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* kNoMemory = "there is not enough memory";

void print(const char* when, const mesh::Distortion& d, double seconds) {
  constexpr double kDegrees = 180 / core::kPi;
  std::printf(
      "%s: areas: spread %.3g, mean %.3g, worst face %.3g, folded %ld, sum %.9g sr; "
      "angles: mean %.3g deg, worst %.3g deg; %.2f s\n",
      when, d.spread, d.mean, d.worst, static_cast<long>(d.folded), d.total_area,
      d.mean_angle * kDegrees, d.worst_angle * kDegrees, seconds);
  std::fflush(stdout);
}

void warn(const std::string& text) {
  std::cerr << "warning: " << core::onOneLine(text) << std::endl;
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

/// The start, or else what the map is compared with.
void printStart(const Task& task) {
  const auto distortionOf = [&](const Points& map) {
    return summary(faceDistortion(task.surface, task.shares, map));
  };
  if (!task.start) {
    const double outwards = task.inside_out ? -1 : 1;
    print("before", distortionOf(outwards * centralProjection(task.surface)), 0);
    return;
  }
  const mesh::Distortion start = distortionOf(*task.start);
  print("before", start, 0);
  if (coversOnce(start)) return;
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

mesh::MeshMap mapOf(const Task& task, const Options& options) {
  try {
    return about(task.shares_from, [&] {
      return options.node.empty() ? mapHere(task, options) : mapByNode(task, options);
    });
  } catch (const mesh::NoMap&) {
    throw std::runtime_error(
        core::onOneLine(options.mesh) +
        ": no map without folds was found, and no file has been written; to help it, begin from "
        "one (--sphere), or give a mesh with fewer thin triangles and areas that differ less");
  }
}

/// Says why the map is no better.
void tellOfEnd(const mesh::MeshMap& map, const Task& task, const Options& options) {
  switch (map.end) {
    case mesh::MapEnd::told:
      return warn("interrupted; the best map so far has been written");
    case mesh::MapEnd::no_memory:
      return warn(std::string(kNoMemory) +
                  " to improve the map further; the best so far has been written");
    case mesh::MapEnd::time:
      std::cout << "the time of " << core::toText(timeFor(task, options))
                << " s is over (--max-time); the spread of " << core::toText(options.spread)
                << " (--spread) is not reached" << std::endl;
      return;
    case mesh::MapEnd::found:
      return;
  }
}

/// Asks what may fail beside the map before that is computed.
void run(const Options& options) {
  const Task task = readTask(options);
  tellOfTask(task, options);
  printStart(task);
  const auto begin = Clock::now();
  const mesh::MeshMap map = mapOf(task, options);
  const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  const std::string written = writeFiles(options, task, map.points, map.faces);
  print("after", map.distortion, seconds);
  printTexture(options, task, map.points);
  tellOfEnd(map, task, options);
  std::cout << "wrote " << written << std::endl;
}

/// The arguments without those of ROS, which roslaunch adds.
std::vector<std::string> ownArguments(int argc, char** argv) {
  ros::V_string arguments;
  ros::removeROSArgs(argc, argv, arguments);
  if (!arguments.empty()) arguments.erase(arguments.begin());
  return arguments;
}

}  // namespace
}  // namespace spherical_springs::relax_mesh

int main(int argc, char** argv) {
  using namespace spherical_springs::relax_mesh;
  try {
    keepInterruptions();
    std::signal(SIGXFSZ, SIG_IGN);  // a file that grows too long is one that cannot be written
    const auto options = parseOptions(ownArguments(argc, argv));
    if (!options) return 0;
    if (!options->node.empty()) {
      ros::init(argc, argv, "relax_mesh",
                ros::init_options::AnonymousName | ros::init_options::NoSigintHandler);
    }
    run(*options);
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
