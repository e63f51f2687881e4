#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>
#include <string>

#include "relax_mesh/options.h"

namespace spherical_springs::relax_mesh {
namespace {

std::string reasonAgainst(std::vector<std::string> further) {
  std::vector<std::string> arguments = {"--mesh", "a.obj", "--output", "b.obj"};
  arguments.insert(arguments.end(), further.begin(), further.end());
  try {
    parseOptions(arguments);
  } catch (const std::invalid_argument& fault) {
    return fault.what();
  }
  return "taken";
}

TEST(Options, AreRead) {
  const auto options = parseOptions(
      {"--mesh",    "a b.obj", "--output=c.obj", "--sphere", "s.obj",          "--uv", "u.obj",
       "--density", "d",       "--metrics",      "m.csv",    "--angle-weight", "0.25", "--node",
       "n",         "--load",  "--spread",       "0.02",     "--max-time",     "1.5e2"});
  ASSERT_TRUE(options);
  EXPECT_EQ("a b.obj", options->mesh);
  EXPECT_EQ("c.obj", options->output);
  EXPECT_EQ("s.obj", options->sphere);
  EXPECT_EQ("u.obj", options->uv);
  EXPECT_EQ("d", options->density);
  EXPECT_EQ("m.csv", options->metrics);
  EXPECT_EQ(0.25, options->angle_weight);
  EXPECT_EQ("n", options->node);
  EXPECT_TRUE(options->load);
  EXPECT_EQ(0.02, options->spread);
  EXPECT_EQ(150, options->max_time);
}

TEST(Options, AreLeftOutWhereNobodyNeedsThem) {
  const auto options = parseOptions({"--mesh", "a.obj", "--output", "b.obj"});
  ASSERT_TRUE(options);
  EXPECT_TRUE(options->sphere.empty());
  EXPECT_TRUE(options->uv.empty());
  EXPECT_EQ(0, options->angle_weight);
  EXPECT_EQ(1e-3, options->spread);
  EXPECT_FALSE(options->max_time);
  EXPECT_EQ("", options->node);
  EXPECT_FALSE(options->load);
  EXPECT_FALSE(parseOptions({"--help"}));
}

TEST(Options, OfRepairsAndTexturesAreRead) {
  const auto options = parseOptions({"--mesh", "a.stl", "--output", "c.obj", "--largest-piece",
                                     "--fill-holes", "12", "--pole", "0,0,-1", "--front=1e-3, 2,3",
                                     "--uv-projection", "equal-area-cylinder"});
  ASSERT_TRUE(options);
  EXPECT_TRUE(options->repairs.largest_piece);
  EXPECT_FALSE(options->repairs.weld);
  EXPECT_EQ(12, options->repairs.longest_hole);
  EXPECT_EQ(mesh::Vector3(0, 0, -1), options->placement.pole);
  EXPECT_EQ(mesh::Vector3(1e-3, 2, 3), options->placement.front);
  EXPECT_EQ(mesh::Projection::equal_area_cylinder, options->projection);
  EXPECT_EQ("--fill-holes is '2'; allowed: the number of edges of a hole, 3 or more",
            reasonAgainst({"--fill-holes", "2"}));
  for (const char* text : {"1,2", "0,0,0", "1,2,3,4", "1;2;3", "nan,0,0", "", "1,2,3x"}) {
    EXPECT_EQ(reasonAgainst({"--pole", text}),
              std::string("--pole is '")
                  .append(text)
                  .append("'; allowed: three numbers X,Y,Z, not all 0"));
  }
  EXPECT_EQ(
      "--uv-projection is 'mercator'; allowed: longitude-latitude, equal-area-cylinder or "
      "equal-area-octahedron",
      reasonAgainst({"--uv-projection", "mercator"}));
}

TEST(Options, AreRefusedWithAReason) {
  EXPECT_THROW(parseOptions({"--mesh", "a.obj"}), std::invalid_argument);
  EXPECT_THROW(parseOptions({"--output", "a.obj"}), std::invalid_argument);
  EXPECT_NE("taken", reasonAgainst({"--mesch", "x"}));
  EXPECT_EQ("unexpected argument 'c.obj'; see relax_mesh --help", reasonAgainst({"c.obj"}));
  EXPECT_EQ("--angle-weight is 'much'; allowed: 0 to 1e6",
            reasonAgainst({"--angle-weight", "much"}));
  EXPECT_EQ("--angle-weight is '1 '; allowed: 0 to 1e6", reasonAgainst({"--angle-weight", "1 "}));
  EXPECT_EQ("--angle-weight is -1; allowed: 0 to 1e6", reasonAgainst({"--angle-weight=-1"}));
  EXPECT_EQ("--angle-weight is nan; allowed: 0 to 1e6", reasonAgainst({"--angle-weight", "nan"}));
  EXPECT_EQ("--spread is 'good'; allowed: above 0", reasonAgainst({"--spread", "good"}));
  EXPECT_EQ("--spread is 0; allowed: above 0", reasonAgainst({"--spread", "0"}));
  EXPECT_EQ("--spread is inf; allowed: above 0", reasonAgainst({"--spread", "inf"}));
  EXPECT_EQ("--max-time is -2; allowed: above 0 [s]", reasonAgainst({"--max-time", "-2"}));
  EXPECT_EQ("--max-time is nan; allowed: above 0 [s]", reasonAgainst({"--max-time", "nan"}));
  EXPECT_EQ("--node is ''; allowed: the name of a node", reasonAgainst({"--node", ""}));
  EXPECT_EQ("--load is given without --node, whose scene it is about", reasonAgainst({"--load"}));
  EXPECT_EQ("--uv is '/nowhere/u.obj'; allowed: a file in a directory that exists",
            reasonAgainst({"--uv", "/nowhere/u.obj"}));
  EXPECT_EQ("--uv is '/dev/null'; allowed: the name of a file",
            reasonAgainst({"--uv", "/dev/null"}));
  EXPECT_EQ("--uv is '.'; allowed: the name of a file", reasonAgainst({"--uv", "."}));
  EXPECT_EQ("--uv is 'u/'; allowed: the name of a file", reasonAgainst({"--uv", "u/"}));
}

TEST(Options, AreShownShortAndOnOneLine) {
  const std::string help = "; see relax_mesh --help", allowed = "; allowed: 0 to 1e6";
  const std::string x(1000, 'x');
  EXPECT_EQ("unrecognised option '--" + x.substr(0, 98) + "...'" + help, reasonAgainst({"--" + x}));
  EXPECT_EQ("unrecognised option '--a?b=?[31m'" + help, reasonAgainst({"--a\nb=\033[31m"}));
  EXPECT_EQ("option '--me=a?b' is ambiguous and matches '--mesh', and '--metrics'" + help,
            reasonAgainst({"--me=a\nb"}));
  EXPECT_EQ("--angle-weight is '" + x.substr(0, 100) + "...' (1000 bytes)" + allowed,
            reasonAgainst({"--angle-weight", x}));
  EXPECT_EQ("--angle-weight is '1?2'" + allowed, reasonAgainst({"--angle-weight=1\n2"}));
  for (const std::string& argument : {x, std::string("\n"), "--node=" + x, "--help=" + x}) {
    const std::string reason = reasonAgainst({"--node", "n", argument});
    EXPECT_NE("taken", reason);
    EXPECT_LT(reason.size(), 200);
    EXPECT_EQ(std::string::npos, reason.find('\n'));
  }
}

TEST(Options, SayWhyAPathIsNone) {
  const std::string name(300, 'x');
  for (const char* option : {"--uv", "--metrics", "--density"}) {
    const std::string what = option == std::string("--density") ? "read " : "write ";
    try {
      reasonAgainst({option, name});
      ADD_FAILURE() << option;
    } catch (const std::runtime_error& fault) {
      EXPECT_EQ("cannot " + what + name + ": File name too long", fault.what());
    }
  }
}

TEST(Options, NameNothingTwice) {
  const std::string allowed = "; allowed: a file of its own, not one that another option names";
  EXPECT_EQ("--uv is './b.obj'" + allowed, reasonAgainst({"--uv", "./b.obj"}));
  EXPECT_EQ("--metrics is 'a.obj'" + allowed, reasonAgainst({"--metrics", "a.obj"}));
  EXPECT_EQ("--output is 'b.obj'" + allowed, reasonAgainst({"--density", "b.obj"}));
}

TEST(Options, NameWhatLinksLeadTo) {
  namespace fs = std::filesystem;
  const fs::path directory =
      fs::temp_directory_path() / ("spherical_springs_options_" + std::to_string(::getpid()));
  fs::create_directory(directory);
  fs::create_symlink("new.obj", directory / "link");
  fs::create_symlink("nowhere/new.obj", directory / "lost");
  const auto path = [&](const char* name) { return (directory / name).string(); };
  EXPECT_EQ("taken", reasonAgainst({"--uv", path("link")}));
  EXPECT_EQ("--metrics is '" + path("link") +
                "'; allowed: a file of its own, not one that another option names",
            reasonAgainst({"--uv", path("new.obj"), "--metrics", path("link")}));
  EXPECT_EQ("--uv is '" + path("lost") + "'; allowed: a file in a directory that exists",
            reasonAgainst({"--uv", path("lost")}));
  fs::remove_all(directory);
}

}  // namespace
}  // namespace spherical_springs::relax_mesh
