// The example of a client in C++, run as a program.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <sstream>
#include <stdexcept>
#include <string>

namespace {

struct Outcome {
  int exit_code;
  std::string output;
};

Outcome relaxScene(const std::string& arguments) {
  const std::string command = std::string(RELAX_SCENE) + " " + arguments + " 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) throw std::runtime_error("popen failed");
  Outcome outcome;
  std::array<char, 256> part;
  while (std::fgets(part.data(), part.size(), pipe)) outcome.output += part.data();
  const int status = pclose(pipe);
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

const std::string kLaunch = LAUNCH_DIRECTORY "/";

TEST(RelaxScene, OpensTheTriangleIntoAnOctant) {
  const Outcome outcome = relaxScene(kLaunch + "octant.json");
  ASSERT_EQ(0, outcome.exit_code) << outcome.output;

  std::istringstream lines(outcome.output);
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ("converged", line);

  std::getline(lines, line);
  double before, after;
  ASSERT_EQ(
      2, std::sscanf(line.c_str(), "potential energy: %lf J before, %lf J after", &before, &after))
      << line;
  EXPECT_GT(before, 0.1);
  EXPECT_LT(after, 1e-12);

  std::array<std::array<double, 3>, 3> points;
  for (std::size_t i = 0; i < 3; ++i) {
    std::getline(lines, line);
    unsigned id;
    auto& [x, y, z] = points[i];
    ASSERT_EQ(4, std::sscanf(line.c_str(), "particle %u: %lf %lf %lf", &id, &x, &y, &z)) << line;
    EXPECT_EQ(i, id);
  }
  EXPECT_FALSE(std::getline(lines, line)) << line;

  constexpr double kPrinted = 1e-5;  // six digits are printed
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double product = 0;
      for (std::size_t k = 0; k < 3; ++k) product += points[i][k] * points[j][k];
      EXPECT_NEAR(i == j ? 1 : 0, product, kPrinted) << i << " and " << j;
    }
  }
}

TEST(RelaxScene, SaysWhatIsWrong) {
  const Outcome nothing = relaxScene("");
  EXPECT_EQ(2, nothing.exit_code);
  EXPECT_EQ("usage: relax_scene SCENE.json\n", nothing.output);

  const Outcome absent = relaxScene(kLaunch + "absent.json");
  EXPECT_EQ(1, absent.exit_code);
  EXPECT_EQ(0u, absent.output.find("relax_scene: ")) << absent.output;
  EXPECT_NE(std::string::npos, absent.output.find("absent.json")) << absent.output;
}

}  // namespace
