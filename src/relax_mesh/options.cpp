#include "relax_mesh/options.h"

#include <algorithm>
#include <boost/lexical_cast/try_lexical_convert.hpp>
#include <boost/program_options.hpp>
#include <iostream>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "base/files.h"
#include "relax_mesh/input_path.h"
#include "spherical_springs/maps/sphere_map.h"
#include "spherical_springs/range.h"

namespace spherical_springs::relax_mesh {
namespace {

namespace fs = std::filesystem;
namespace po = boost::program_options;

constexpr double kMost = std::numeric_limits<double>::max();

/// Not by Boost, which shows a text that is none as it is, however long.
double parsed(const char* option, const core::Range& range, const std::string& text) {
  double number;
  if (!boost::conversion::try_lexical_convert(text, number)) {
    throw std::invalid_argument(std::string(option) + " is " + core::quoted(text) +
                                "; allowed: " + range.allowed);
  }
  core::requireInside(range, number, option);
  return number;
}

int parseHole(const std::string& text) {
  constexpr int kShortest = 3;
  int edges;
  if (!boost::conversion::try_lexical_convert(text, edges) || edges < kShortest) {
    throw std::invalid_argument("--fill-holes is " + core::quoted(text) +
                                "; allowed: the number of edges of a hole, 3 or more");
  }
  return edges;
}

mesh::Projection parseProjection(const std::string& text) {
  try {
    return mesh::projection(text);
  } catch (const std::invalid_argument& fault) {
    throw std::invalid_argument(std::string("--uv-projection is ") + fault.what());
  }
}

mesh::Vector3 parseDirection(const char* option, const std::string& text) {
  mesh::Vector3 direction;
  std::istringstream in(text);
  char first_comma = 0, second_comma = 0;
  in >> direction[0] >> first_comma >> direction[1] >> second_comma >> direction[2];
  if (!in || !(in >> std::ws).eof() || first_comma != ',' || second_comma != ',' ||
      !direction.allFinite() || direction.isZero(0)) {
    throw std::invalid_argument(std::string(option) + " is " + core::quoted(text) +
                                "; allowed: three numbers X,Y,Z, not all 0");
  }
  return direction;
}

po::options_description described(Options& options) {
  const auto path = [](fs::path& target) {
    return po::value<std::string>()->notifier(
        [&](const std::string& text) { target = core::homeExpanded(text); });
  };
  const auto input = [](fs::path& target) {
    return po::value<std::string>()->notifier(
        [&](const std::string& text) { target = inputPath(text); });
  };
  const auto towards = [](std::optional<mesh::Vector3>& target, const char* option) {
    return po::value<std::string>()->notifier(
        [&target, option](const std::string& text) { target = parseDirection(option, text); });
  };
  constexpr core::Range kSpread{0, kMost, "above 0", true}, kTime{0, kMost, "above 0 [s]", true};
  const auto number = [](const char* option, const core::Range& range, auto& target) {
    return po::value<std::string>()->notifier(
        [=, &target](const std::string& text) { target = parsed(option, range, text); });
  };
  po::options_description all(
      "relax_mesh: maps a closed surface to the sphere, every face to its share of the area.\n"
      "Ctrl-C ends the search: the best map so far is written. A second one ends the command at "
      "once.\n\nOptions");
  auto add = all.add_options();
  add("help", "show this");
  add("mesh", input(options.mesh)->required(),
      "the surface: an OBJ, PLY, STL or OFF file, closed, in one piece, without handles; a path, "
      "or "
      "a URL package://PACKAGE/PATH or file:///PATH");
  add("output", path(options.output)->required(),
      "OBJ file to write: the same faces, their vertices on the unit sphere");
  add("sphere", input(options.sphere), "start from the vertices of this file");
  add("uv", path(options.uv),
      "OBJ file to write: the surface with texture coordinates, its faces cut at seams and poles");
  add("uv-projection",
      po::value<std::string>()
          ->default_value("longitude-latitude")
          ->notifier([&](const std::string& text) { options.projection = parseProjection(text); }),
      "of the sphere to texture coordinates: longitude-latitude, equal-area-cylinder or "
      "equal-area-octahedron");
  add("pole", towards(options.placement.pole, "--pole"),
      "X,Y,Z: the vertex farthest in this direction comes to lie at the north pole of the map");
  add("front", towards(options.placement.front, "--front"),
      "X,Y,Z: the vertex farthest in this direction comes to lie in the middle of the texture, "
      "with "
      "--pole on its middle meridian");
  add("weld", po::bool_switch(&options.repairs.weld),
      "make vertices with the same coordinates one vertex (STL files: always)");
  add("largest-piece", po::bool_switch(&options.repairs.largest_piece),
      "keep only the piece of the largest area");
  add("fill-holes", po::value<std::string>()->notifier([&](const std::string& text) {
    options.repairs.longest_hole = parseHole(text);
  }),
      "fill holes of up to so many edges");
  add("spread", number("--spread", kSpread, options.spread),
      "how good the map is to be: standard deviation of log(area / share) at which the search "
      "ends; "
      "0.001 if left out");
  add("max-time", number("--max-time", kTime, options.max_time),
      "how long it may take [s]; by the number of vertices if left out: 17, or more above 10,000 "
      "of them");
  add("angle-weight", number("--angle-weight", mesh::kAngleWeights, options.angle_weight),
      "0 (if left out): every face gets its share of the area, whatever becomes of its angles; the "
      "more (up to 1e6), the better corner angles are kept, and the worse areas");
  add("density", input(options.density),
      "file of positive numbers, one a face in the mesh's order; a face of density 2 gets twice "
      "the area on the sphere that it would get with 1");
  add("metrics", path(options.metrics), "CSV file to write: areas and angles, face by face");
  add("node", po::value(&options.node),
      "name of a node that is to map, by its action map_mesh, in place of this process");
  add("load", po::bool_switch(&options.load),
      "with --node: the map, as springs, becomes the scene of the node");
  return all;
}

[[noreturn]] void refuse(const char* option, const fs::path& path, const char* allowed) {
  throw std::invalid_argument(std::string(option) + " is " + core::quoted(path.string()) +
                              "; allowed: " + allowed);
}

/// Refuses an output file that is also read, or written twice.
void requireWritable(const Options& options) {
  const auto whole = [](const fs::path& path) {
    return fs::weakly_canonical(core::linksFollowed(fs::absolute(path)));
  };
  std::vector<fs::path> taken;
  for (const fs::path* read : {&options.mesh, &options.sphere, &options.density}) {
    if (read->empty()) continue;
    taken.push_back(core::orFailTo("read", *read, [&] { return whole(*read); }));
  }
  const auto require = [&](const char* option, const fs::path& path) {
    if (!path.has_filename() || (fs::exists(path) && !fs::is_regular_file(path))) {
      refuse(option, path, "the name of a file");
    }
    if (!fs::is_directory(whole(path).parent_path())) {
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

/// Every argument belongs to an option; half of a file's name without quotes does not.
void requireOptionsOnly(const po::parsed_options& parsed) {
  for (const po::option& option : parsed.options) {
    if (option.position_key < 0) continue;
    throw std::invalid_argument("unexpected argument " + core::quoted(option.value.front()) +
                                "; see relax_mesh --help");
  }
}

[[noreturn]] void refuse(const po::error& fault) {
  throw std::invalid_argument(std::string(fault.what()) + "; see relax_mesh --help");
}

}  // namespace

std::optional<Options> parseOptions(const std::vector<std::string>& arguments) {
  Options options;
  const po::options_description all = described(options);
  po::variables_map values;
  try {
    const po::parsed_options parsed = po::command_line_parser(arguments).options(all).run();
    requireOptionsOnly(parsed);
    po::store(parsed, values);
    if (arguments.empty() || values.count("help") > 0) {
      std::cout << all;
      return std::nullopt;
    }
    po::notify(values);
  } catch (po::error_with_no_option_name& fault) {  // but with the argument as it was given
    fault.set_original_token(core::shortened(fault.get_option_name()));
    refuse(fault);
  } catch (const po::error& fault) {
    refuse(fault);
  }
  if (values.count("node") > 0 && options.node.empty()) {
    throw std::invalid_argument("--node is ''; allowed: the name of a node");
  }
  if (options.load && options.node.empty()) {
    throw std::invalid_argument("--load is given without --node, whose scene it is about");
  }
  requireWritable(options);
  return options;
}

}  // namespace spherical_springs::relax_mesh
