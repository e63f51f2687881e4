#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "node/parameter_values.h"
#include "node/unknown_parameters.h"

namespace spherical_springs {
namespace {

using Value = XmlRpc::XmlRpcValue;

TEST(ParameterValues, TakeNumbersAsPeopleWriteThem) {
  EXPECT_EQ(valueIn<double>(Value("1e-3")), 1e-3);
  EXPECT_EQ(valueIn<double>(Value(2)), 2.);
  EXPECT_EQ(valueIn<int>(Value(2.0)), 2);
  EXPECT_EQ(valueIn<int>(Value(1.0e6)), 1000000);
  EXPECT_EQ(valueIn<int>(Value("1e6")), 1000000);
  EXPECT_EQ(valueIn<bool>(Value("true")), true);
  EXPECT_EQ(valueIn<bool>(Value(false)), false);
}

TEST(ParameterValues, TakeNothingForSomethingElse) {
  for (const char* text : {"", "fast", "1 ms", "1e-3s", "0,5", "true"}) {
    EXPECT_EQ(valueIn<double>(Value(text)), std::nullopt) << text;
  }
  for (const double number : {0.5, 1e10, -3e9}) {
    EXPECT_EQ(valueIn<int>(Value(number)), std::nullopt) << number;
  }
  EXPECT_EQ(valueIn<int>(Value("nan")), std::nullopt);
  EXPECT_EQ(valueIn<double>(Value(true)), std::nullopt);
  EXPECT_EQ(valueIn<bool>(Value(1)), std::nullopt);
  EXPECT_EQ(valueIn<std::string>(Value(2024)), std::nullopt);
}

TEST(ParameterValues, AreToldByTheirType) {
  EXPECT_EQ(typeFault<double>(Value("fast")), ", a text where a number is wanted");
  EXPECT_EQ(typeFault<int>(Value(0.5)), "");
  EXPECT_EQ(typeFault<bool>(Value(1)), ", a number where a truth value is wanted");
  EXPECT_EQ(typeFault<std::string>(Value(true)),
            ", a truth value where a text is wanted (in YAML, quote it)");
}

TEST(NearestName, NeedsTheFewestChanges) {
  const std::vector<std::string> names = {"time_step", "integrator", "threads", "radius"};
  EXPECT_EQ(nearestName("timestep", names), "time_step");
  EXPECT_EQ(nearestName("intergrator", names), "integrator");
  EXPECT_EQ(nearestName("Radius", names), "radius");
  EXPECT_EQ(nearestName("thread", names), "threads");
}

}  // namespace
}  // namespace spherical_springs
