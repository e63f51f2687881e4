#include "options.h"

#include <algorithm>
#include <boost/program_options.hpp>
#include <iostream>
#include <stdexcept>

#include "../files.h"
#include "spherical_springs/range.h"

namespace spherical_springs::relax_mesh {
namespace {

namespace fs = std::filesystem;
namespace po = boost::program_options;

po::options_description described(Options& options) {
  const auto path = [](fs::path& target) {
    return po::value<std::string>()->notifier([&](const std::string& text) { target = text; });
  };
  po::options_description all(
      "relax_mesh: maps a closed surface to the sphere, every face to its share of the area.\n"
      "The node at work is left paused, with the map in place of the scene that it "
      "had.\n\nOptions");
  auto add = all.add_options();
  add("help", "show this");
  add("mesh", path(options.mesh)->required(),
      "the surface: an OBJ file of triangles, closed, in one piece, without handles");
  add("output", path(options.output)->required(),
      "OBJ file to write: the same faces, their vertices on the unit sphere");
  add("sphere", path(options.sphere), "start from the vertices of this OBJ file");
  add("uv", path(options.uv),
      "OBJ file to write: the surface with longitude and latitude as texture coordinates");
  add("angle-weight", po::value(&options.angle_weight)->default_value(0, "0"),
      "0: every face gets its share of the area, whatever becomes of its angles; the more (up to "
      "1e6), the better corner angles are kept, and the worse areas");
  add("density", path(options.density),
      "file of positive numbers, one a face in the mesh's order; a face of density 2 gets twice the "
      "area on the sphere that it would get with 1");
  add("metrics", path(options.metrics), "CSV file to write: areas and angles, face by face");
  add("node", po::value(&options.node)->default_value("spherical_springs"),
      "name of the node that relaxes");
  return all;
}

[[noreturn]] void refuse(const char* option, const fs::path& path, const char* allowed) {
  throw std::invalid_argument(std::string(option) + " is " + core::quoted(path.string()) +
                              "; allowed: " + allowed);
}

/// What is to be written, none of it over anything that is read or written as well.
void requireWritable(const Options& options) {
  const auto whole = [](const fs::path& path) { return fs::weakly_canonical(fs::absolute(path)); };
  std::vector<fs::path> taken;
  for (const fs::path* read : {&options.mesh, &options.sphere, &options.density}) {
    if (read->empty()) continue;
    taken.push_back(core::orFailTo("read", *read, [&] { return whole(*read); }));
  }
  const auto require = [&](const char* option, const fs::path& path) {
    if (!path.has_filename() || (fs::exists(path) && !fs::is_regular_file(path))) {
      refuse(option, path, "the name of a file");
    }
    if (path.has_parent_path() && !fs::is_directory(path.parent_path())) {
      refuse(option, path, "a file in a directory that exists");
    }
    if (std::find(taken.begin(), taken.end(), whole(path)) != taken.end()) {
      refuse(option, path, "a file of its own, not one that another option names");
    }
    taken.push_back(whole(path));
  };
  const auto requireOrFail = [&](const char* option, const fs::path& path) {
    core::orFailTo("write", path, [&] { require(option, path); });
  };
  requireOrFail("--output", options.output);
  if (!options.uv.empty()) requireOrFail("--uv", options.uv);
  if (!options.metrics.empty()) requireOrFail("--metrics", options.metrics);
}

}  // namespace

std::optional<Options> parseOptions(const std::vector<std::string>& arguments) {
  Options options;
  const po::options_description all = described(options);
  po::variables_map values;
  try {
    po::store(po::command_line_parser(arguments).options(all).positional({}).run(), values);
    if (arguments.empty() || values.count("help") > 0) {
      std::cout << all;
      return std::nullopt;
    }
    po::notify(values);
  } catch (const po::error& fault) {
    throw std::invalid_argument(std::string(fault.what()) + "; see relax_mesh --help");
  }
  core::requireInside({0, 1e6, "0 to 1e6"}, options.angle_weight, "--angle-weight");
  requireWritable(options);
  return options;
}

}  // namespace spherical_springs::relax_mesh
